#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace terrella {

/// One row of tiles of a level, as one picture: RGBA8, `tiles` · tile_px wide, tile_px high.
struct Strip {
  int level = 0;
  std::int64_t tile_y = 0;
  std::int64_t tile_x0 = 0;  ///< column of the first tile
  std::int64_t tiles = 0;
  int tile_px = 0;
  int squeeze = 0;           ///< each squeezed tile of this row spans 2^squeeze columns; 0: no squeezed tiles
  std::int64_t turn_px = 0;  ///< pixels round the planet; 0: the strip does not wrap
  std::vector<std::uint8_t> rgba = {};

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
  using Pixels = std::vector<std::uint8_t>;
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
