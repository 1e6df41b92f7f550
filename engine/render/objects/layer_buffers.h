#pragma once

#include <array>
#include <vector>

#include "objects/layer_objects.h"
#include "render/gl/gl_handle.h"
#include "render/objects/icon_atlas.h"

namespace terrella {

/// A buffer that follows a list: the buffer grows with the list, and uploads only changes. thread: main
class FollowingBuffer {
 public:
  template <class T>
  void follow(const std::vector<T>& items, ChangedRanges& changed) {
    constexpr std::size_t kGapBytes = 2048;  // a second call costs more than these bytes
    if (changed.empty()) return;
    if (items.size() * sizeof(T) > capacity_) return fill(items.data(), items.size() * sizeof(T)), changed.forget();
    for (const ChangedRanges::Range& range : changed.take(kGapBytes / sizeof(T))) {
      put(range.first * sizeof(T), items.data() + range.first, (range.end - range.first) * sizeof(T));
    }
  }
  [[nodiscard]] GLuint name() const { return buffer_.name(); }

 private:
  void fill(const void* data, std::size_t bytes);
  void put(std::size_t at, const void* data, std::size_t bytes) const;

  gl::Buffer buffer_;
  std::size_t capacity_ = 0;  ///< bytes
};

/// The GPU's copy of one layer's objects. thread: main
struct LayerBuffers {
  using Buckets = std::array<FollowingBuffer, Batch<char>::kBuckets>;
  FollowingBuffer spheres;
  Buckets markers, icons, lines, fill_vertices, fill_indices, solids;
  FollowingBuffer draped_lines, draped_fills;
  std::vector<Buckets> stands;  ///< per model of the layer
  IconAtlas icon_atlas;

  /// Uploads the changes since the last call.
  void follow(LayerObjects& objects);
};

/// A layer that a frame draws.
struct DrawnLayer {
  LayerObjects* objects;
  LayerBuffers* buffers;
};

}  // namespace terrella
