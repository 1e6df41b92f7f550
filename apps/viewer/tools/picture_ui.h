#pragma once

#include <functional>

#include "base/result.h"
#include "geo/camera.h"

namespace terrella {

/// Draws over a framebuffer with Dear ImGui, as the window does: `draw` is called within a frame whose units are
/// pixels. Fails if Dear ImGui finds no OpenGL. Call it without a window, at most one at a time. thread: that of the
/// OpenGL context
[[nodiscard]] Status draw_over_picture(unsigned framebuffer, Viewport size, const std::function<void()>& draw);

}  // namespace terrella
