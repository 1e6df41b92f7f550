#include "render/gl/stream_buffer.h"

namespace terrella {

void StreamBuffer::fill(const void* data, std::size_t bytes) {
  begin(bytes);
  put(0, data, bytes);
}

void StreamBuffer::begin(std::size_t bytes) {
  turn_ = (turn_ + 1) % buffers_.size();
  Part& part = buffers_[turn_];
  if (!part.buffer) part.buffer = gl::make_buffer();
  if (part.capacity >= bytes) return;
  part.capacity = bytes + bytes / 4;
  glNamedBufferData(part.buffer.name(), static_cast<GLsizeiptr>(part.capacity), nullptr, GL_STREAM_DRAW);
}

void StreamBuffer::put(std::size_t at, const void* data, std::size_t bytes) const {
  if (bytes == 0) return;
  glNamedBufferSubData(name(), static_cast<GLintptr>(at), static_cast<GLsizeiptr>(bytes), data);
}

}  // namespace terrella
