#include "render/stream_buffer.h"

namespace terrella {

void StreamBuffer::fill(const void* data, std::size_t bytes) {
  turn_ = (turn_ + 1) % buffers_.size();
  Part& part = buffers_[turn_];
  if (!part.buffer) part.buffer = gl::make_buffer();
  if (part.capacity < bytes) {
    part.capacity = bytes + bytes / 4;
    glNamedBufferData(part.buffer.name(), static_cast<GLsizeiptr>(part.capacity), nullptr, GL_STREAM_DRAW);
  }
  if (bytes > 0) glNamedBufferSubData(part.buffer.name(), 0, static_cast<GLsizeiptr>(bytes), data);
}

}  // namespace terrella
