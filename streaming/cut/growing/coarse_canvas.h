#pragma once

#include <cstdint>
#include <shared_mutex>
#include <span>
#include <vector>

#include "codecs/image.h"
#include "streaming/cut/cut_plan.h"

namespace terrella {

/// A small picture of a picture that is being cut, on the pixels of one level of the cut's grid. Tiles of any level are
/// made from it until the cut's own are there. Places that are not painted yet are transparent. thread: any, several at
/// once
class CoarseCanvas {
 public:
  /// Takes the finest level that is at most kWidestCanvas_px wide.
  explicit CoarseCanvas(const CutPlan& plan);

  /// Grid of the tiles that paint() takes: the plan's, down to the canvas's level, without squeezed tiles.
  [[nodiscard]] const TileGrid& grid() const { return grid_; }
  /// Tiles of that level under the picture, from the north-west.
  [[nodiscard]] std::vector<TileId> tiles() const;
  void paint(const TileId& id, const Image& tile);

  /// Distance of the rows that add_row() needs.
  [[nodiscard]] std::int64_t row_step() const;
  /// Adds a row of the picture on the plan's grid: RGBA8. Rows come from the top. thread: one at a time
  void add_row(std::int64_t row, std::span<const std::uint8_t> rgba);

  /// Makes a tile of the plan's grid, squeezed ones too.
  [[nodiscard]] Image tile(const TileId& id) const;

 private:
  /// Pixels of the canvas under a pixel of a tile, with weights that sum up to 1.
  struct Taps {
    std::vector<std::pair<std::int64_t, float>> pixels;
  };
  [[nodiscard]] Taps taps(double from, double to, std::int64_t first, std::int64_t size, std::int64_t turn,
                          bool clamped) const;
  void put_row(std::int64_t row);

  CutPlan plan_;
  TileGrid grid_;
  PixelRect px_;          ///< pixels of the picture at the canvas's level
  int halvings_;          ///< levels between the canvas and the finest
  std::int64_t turn_px_;  ///< pixels of 360° at the canvas's level; 0: the picture does not go round or cross ±180°
  std::int64_t summing_ = -1;        ///< row of the canvas that is being summed
  std::vector<float> sums_;          ///< sums of that row's pixels, weighted by alpha
  std::vector<float> counts_;        ///< number of the picture's pixels in each sum
  mutable std::shared_mutex mutex_;  ///< guards pixels_
  std::vector<std::uint8_t> pixels_;
};

}  // namespace terrella
