#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace terrella {

/// Returns memory in whole pages, which go back to the system when freed. malloc() would keep blocks of this size, and
/// the larger they are the more of other memory. Throws std::bad_alloc. thread: any
[[nodiscard]] void* take_pages(std::size_t bytes);
/// thread: any
void give_pages_back(void* pages, std::size_t bytes);

template <class T>
struct PageAllocator {
  using value_type = T;
  PageAllocator() = default;
  template <class U>
  explicit PageAllocator(const PageAllocator<U>&) {}
  [[nodiscard]] T* allocate(std::size_t count) { return static_cast<T*>(take_pages(count * sizeof(T))); }
  void deallocate(T* pages, std::size_t count) { give_pages_back(pages, count * sizeof(T)); }
  bool operator==(const PageAllocator&) const = default;
};
using StripPixels = std::vector<std::uint8_t, PageAllocator<std::uint8_t>>;

/// One row of tiles of a level, as one picture: RGBA8, `tiles` · tile_px wide, tile_px high.
struct Strip {
  int level = 0;
  std::int64_t tile_y = 0;
  std::int64_t tile_x0 = 0;  ///< column of the first tile
  std::int64_t tiles = 0;
  int tile_px = 0;
  int squeeze = 0;           ///< each squeezed tile of this row spans 2^squeeze columns; 0: no squeezed tiles
  std::int64_t turn_px = 0;  ///< pixels round the planet; 0: the strip does not wrap
  StripPixels rgba = {};

  [[nodiscard]] std::size_t stride_bytes() const {
    return static_cast<std::size_t>(tiles) * static_cast<std::size_t>(tile_px) * 4;
  }
  [[nodiscard]] std::uint8_t* row(std::int64_t y) { return rgba.data() + static_cast<std::size_t>(y) * stride_bytes(); }
  [[nodiscard]] const std::uint8_t* tile(std::int64_t index) const {
    return rgba.data() + static_cast<std::size_t>(index) * static_cast<std::size_t>(tile_px) * 4;
  }
};

/// Lends strips and reuses their memory, because fresh pages cost as much as halving. One limit covers both lent and
/// kept strips, and thereby bounds the cutter's memory. The pool must outlive its strips. thread: any
class StripPool {
 public:
  explicit StripPool(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// Lends a strip of that shape with undefined pixels. Blocks until enough lent memory has come back.
  [[nodiscard]] std::shared_ptr<Strip> lend(const Strip& shape);
  /// Bytes of lent and kept strips: at most `max_bytes`, or the only lent strip if that is larger.
  [[nodiscard]] std::size_t held_bytes() const;

 private:
  using Pixels = StripPixels;
  void take_back(Strip* strip);
  [[nodiscard]] std::vector<Pixels> drop_free();

  std::size_t max_bytes_;
  mutable std::mutex mutex_;
  std::condition_variable returned_;
  std::size_t lent_bytes_ = 0;
  std::size_t free_bytes_ = 0;
  std::multimap<std::size_t, Pixels> free_;
};

}  // namespace terrella
