#pragma once

#include <epoxy/gl.h>

#include <cstddef>

namespace terrella::gl {

/// An input of the vertex stage: `size` floats that begin `offset` bytes into each element of the buffer at `binding`.
/// thread: main (of the context)
inline void float_attribute(GLuint array, GLuint index, GLuint binding, GLint size, std::size_t offset) {
  glEnableVertexArrayAttrib(array, index);
  glVertexArrayAttribFormat(array, index, size, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array, index, binding);
}

/// The same of a colour of four bytes, as floats from 0 to 1.
inline void color_attribute(GLuint array, GLuint index, GLuint binding, std::size_t offset) {
  glEnableVertexArrayAttrib(array, index);
  glVertexArrayAttribFormat(array, index, 4, GL_UNSIGNED_BYTE, GL_TRUE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array, index, binding);
}

}  // namespace terrella::gl
