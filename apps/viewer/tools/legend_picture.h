#pragma once

#include <vector>

#include "apps/viewer/panels/legend.h"
#include "base/result.h"
#include "geo/camera.h"

namespace terrella {

/// Draws a legend into the lower left corner of a framebuffer, as the window shows it. Fails if Dear ImGui finds no
/// OpenGL. Call it without a window, at most one at a time. thread: that of the OpenGL context
[[nodiscard]] Status draw_legend_over(unsigned framebuffer, Viewport size, const std::vector<LegendItem>& items);

}  // namespace terrella
