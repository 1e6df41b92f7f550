#pragma once

#include <string>

#include "view/render_modes.h"

namespace terrella {

/// Returns GLSL 4.50 text, without a version line, for shaders that draw into a globe's frame (Globe::on_draw()). It
/// declares terrella_from_eye(), terrella_clip() and TERRELLA_WRITE_DEPTH, which place a vertex and its depth as the
/// globe does. The text reads the uniform block at binding 0, which the globe binds. thread: any
[[nodiscard]] std::string caller_glsl(DepthMode depth);

}  // namespace terrella
