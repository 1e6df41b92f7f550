#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "tiles/tile_source.h"

namespace terrella::test {

/// Tiles of numbers, painted when they are asked for.
class PaintedNumbers : public TileSource {
 public:
  /// The number of a texel's centre by longitude and row latitude, degrees; NaN: no data. thread: worker
  using Paint = std::function<float(double lon_deg, double row_deg)>;

  /// `meaning`: as NumberInfo of the set says of numbers that are decoded already.
  PaintedNumbers(const TileGrid& grid, Paint paint, const NumberInfo& meaning = {.floats = true});
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override;
  [[nodiscard]] int reads() const { return reads_; }

 private:
  TileSetInfo info_;
  Paint paint_;
  std::atomic<int> reads_ = 0;
};

}  // namespace terrella::test
