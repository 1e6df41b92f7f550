#pragma once

namespace terrella {

/// How patches are textured: shaders/README.md. `automatic` is the command line's `auto`.
enum class Texturing { vertex, paper, exact, automatic };

/// How depth is stored (DESIGN 6).
enum class DepthMode { reversed, logarithmic, standard };

}  // namespace terrella
