#pragma once

#include <epoxy/gl.h>

#include "base/result.h"

namespace terrella {

/// Fails if a framebuffer of the application is not there or not complete. thread: main (of the context)
[[nodiscard]] Status check_framebuffer(GLuint framebuffer);
/// Fails if a complete framebuffer has no colours to draw into, or whole numbers in place of colours.
[[nodiscard]] Status check_colors(GLuint framebuffer);
/// Fails if a complete framebuffer has no depth.
[[nodiscard]] Status check_depth(GLuint framebuffer);

}  // namespace terrella
