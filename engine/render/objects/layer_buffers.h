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
  /// False if the driver has no memory for the list; the next call tries again.
  template <class T>
  [[nodiscard]] bool follow(const std::vector<T>& items, ChangedRanges& changed) {
    constexpr std::size_t kGapBytes = 2048;  // a second call costs more than these bytes
    if (changed.empty()) return true;
    if (items.size() * sizeof(T) > capacity_) {
      const bool is_filled = fill(items.data(), items.size() * sizeof(T));
      if (is_filled) changed.forget();
      return is_filled;
    }
    for (const ChangedRanges::Range& range : changed.take(kGapBytes / sizeof(T))) {
      put(range.first * sizeof(T), items.data() + range.first, (range.end - range.first) * sizeof(T));
    }
    return true;
  }
  [[nodiscard]] GLuint name() const { return buffer_.name(); }

 private:
  [[nodiscard]] bool fill(const void* data, std::size_t bytes);
  void put(std::size_t at, const void* data, std::size_t bytes) const;

  gl::Buffer buffer_;
  std::size_t capacity_ = 0;  ///< bytes
};

/// The GPU's copy of one layer's objects. thread: main
struct LayerBuffers {
  using Buckets = std::array<FollowingBuffer, Batch<char>::kBuckets>;
  FollowingBuffer spheres;
  Buckets markers, icons, casings, lines, fill_vertices, fill_indices, solids;
  std::vector<Buckets> stands;  ///< per model of the layer
  IconAtlas icon_atlas;

  /// Uploads the changes since the last call. False if the driver has no memory for them; the layer cannot be drawn
  /// then.
  [[nodiscard]] bool follow(LayerObjects& objects);
};

/// A layer that a frame draws.
struct DrawnLayer {
  LayerObjects* objects;
  LayerBuffers* buffers;
};

}  // namespace terrella
