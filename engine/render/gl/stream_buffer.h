#pragma once

#include <array>
#include <cstddef>

#include "render/gl/gl_handle.h"

namespace terrella {

/// A buffer that is refilled for each use, while earlier contents may still be in use by the GPU. thread: main
class StreamBuffer {
 public:
  void fill(const void* data, std::size_t bytes);
  /// Fills the buffer in pieces: begin() reserves space for all pieces, then put() writes each to its place.
  void begin(std::size_t bytes);
  void put(std::size_t at, const void* data, std::size_t bytes) const;
  [[nodiscard]] GLuint name() const { return buffers_[turn_].buffer.name(); }

 private:
  struct Part {
    gl::Buffer buffer;
    std::size_t capacity = 0;  ///< bytes
  };
  std::array<Part, 3> buffers_;
  std::size_t turn_ = 0;
};

}  // namespace terrella
