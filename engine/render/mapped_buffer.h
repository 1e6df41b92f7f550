#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "render/gl_handle.h"

namespace terrella {

/// A buffer that is written in place each time it is used, while the ones before it may still be in use: on software GL
/// what is written is what is read, without a copy. thread: main
class MappedBuffer {
 public:
  /// Room for so many values, once the GPU has done with what was there; nothing is known of what they are. They may be
  /// written, and read back, until use_ends(). Nothing if there is no memory for them.
  template <class T>
  [[nodiscard]] std::span<T> begin(std::size_t count) {
    std::byte* bytes = begin_bytes(count * sizeof(T));
    return {reinterpret_cast<T*>(bytes), bytes == nullptr ? 0 : count};
  }
  /// The draw calls that read it have been made.
  void use_ends();
  [[nodiscard]] GLuint name() const { return parts_[turn_].buffer.name(); }

 private:
  [[nodiscard]] std::byte* begin_bytes(std::size_t bytes);

  struct Part {
    gl::Buffer buffer;
    gl::Fence in_use;
    std::byte* memory = nullptr;
    std::size_t capacity = 0;  ///< bytes
  };
  std::array<Part, 3> parts_;
  std::size_t turn_ = 0;
};

}  // namespace terrella
