#pragma once

#include <epoxy/gl.h>

namespace terrella {

/// Bits of the stencil buffer (engine/DESIGN.md, 7).
inline constexpr GLuint kSurfaceBit = 1;   ///< the surface is here: no sky
inline constexpr GLuint kRightEyeBit = 2;  ///< interlaced stereo: this row is the right eye's
inline constexpr GLuint kThroughBit = 4;   ///< an object is here that asks to be seen through the surface

}  // namespace terrella
