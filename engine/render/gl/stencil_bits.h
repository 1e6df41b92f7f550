#pragma once

#include <epoxy/gl.h>

namespace terrella {

/// Bits of the stencil buffer (engine/DESIGN.md, 7).
inline constexpr GLuint kSurfaceBit = 1;   ///< the surface covers this pixel: no sky
inline constexpr GLuint kRightEyeBit = 2;  ///< interlaced stereo: this row belongs to the right eye
inline constexpr GLuint kThroughBit = 4;   ///< this pixel shows an object that asks to be seen through the surface

}  // namespace terrella
