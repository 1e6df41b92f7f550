#pragma once

#include <epoxy/gl.h>

#include <cstddef>

namespace terrella::gl {

/// Declares an input of the vertex stage: `size` floats at `offset` bytes into each element of the buffer at `binding`.
/// thread: main
inline void float_attribute(GLuint array, GLuint index, GLuint binding, GLint size, std::size_t offset) {
  glEnableVertexArrayAttrib(array, index);
  glVertexArrayAttribFormat(array, index, size, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array, index, binding);
}

/// Reads `size` unsigned 32-bit integers, which the shader takes as integers.
inline void uint_attribute(GLuint array, GLuint index, GLuint binding, GLint size, std::size_t offset) {
  glEnableVertexArrayAttrib(array, index);
  glVertexArrayAttribIFormat(array, index, size, GL_UNSIGNED_INT, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array, index, binding);
}

/// Declares an input of `size` unsigned 16-bit integers, as floats of their values. thread: main
inline void short_attribute(GLuint array, GLuint index, GLuint binding, GLint size, std::size_t offset) {
  glEnableVertexArrayAttrib(array, index);
  glVertexArrayAttribFormat(array, index, size, GL_UNSIGNED_SHORT, GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array, index, binding);
}

/// Declares a colour input of four bytes, as floats from 0 to 1. thread: main
inline void color_attribute(GLuint array, GLuint index, GLuint binding, std::size_t offset) {
  glEnableVertexArrayAttrib(array, index);
  glVertexArrayAttribFormat(array, index, 4, GL_UNSIGNED_BYTE, GL_TRUE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(array, index, binding);
}

}  // namespace terrella::gl
