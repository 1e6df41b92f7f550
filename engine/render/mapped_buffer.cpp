#include "render/mapped_buffer.h"

namespace terrella {
namespace {

constexpr GLbitfield kMapping = GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;

}  // namespace

std::byte* MappedBuffer::begin_bytes(std::size_t bytes) {
  turn_ = (turn_ + 1) % parts_.size();
  Part& part = parts_[turn_];
  part.in_use.wait();
  if (part.capacity < bytes) {
    part.capacity = bytes + bytes / 4;
    const auto size = static_cast<GLsizeiptr>(part.capacity);
    part.buffer = gl::make_buffer();
    glNamedBufferStorage(part.buffer.name(), size, nullptr, kMapping);
    part.memory = static_cast<std::byte*>(glMapNamedBufferRange(part.buffer.name(), 0, size, kMapping));
  }
  return part.memory;
}

void MappedBuffer::use_ends() { parts_[turn_].in_use = gl::Fence::here(); }

}  // namespace terrella
