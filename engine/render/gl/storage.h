#pragma once

#include <cstddef>

#include "render/gl/gl_handle.h"

namespace terrella::gl {

/// True if a texture has got its memory. If not, takes the error of OpenGL that the refusal left. thread: main (of the
/// context)
[[nodiscard]] inline bool has_storage(const Texture& texture) {
  GLint is_fixed = GL_FALSE;
  glGetTextureParameteriv(texture.name(), GL_TEXTURE_IMMUTABLE_FORMAT, &is_fixed);
  if (is_fixed == GL_FALSE) static_cast<void>(glGetError());
  return is_fixed != GL_FALSE;
}

/// True if a buffer has got that memory. If not, takes the error of OpenGL that the refusal left. thread: main (of the
/// context)
[[nodiscard]] inline bool has_storage(const Buffer& buffer, std::size_t bytes) {
  GLint64 got = 0;
  glGetNamedBufferParameteri64v(buffer.name(), GL_BUFFER_SIZE, &got);
  const bool is_there = got == static_cast<GLint64>(bytes);
  if (!is_there) static_cast<void>(glGetError());
  return is_there;
}

}  // namespace terrella::gl
