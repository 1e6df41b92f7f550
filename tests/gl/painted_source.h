#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>

#include "tiles/tile_source.h"

namespace terrella::test {

using Color = std::array<std::uint8_t, 3>;

/// Tiles that are painted when they are asked for, in memory.
class PaintedSource : public TileSource {
 public:
  /// `paint` gives the colour of a texel's centre by longitude and row latitude, degrees. thread: worker
  using Paint = std::function<Color(double lon_deg, double row_deg)>;
  /// True for tiles that the source lacks. thread: worker
  using Lacks = std::function<bool(const TileId&)>;

  PaintedSource(const TileGrid& grid, Paint paint, Lacks lacks = {});
  /// A texel becomes the mean over `side` by `side` places in it, as a pyramid of tiles has it. Before the first read.
  void average(int side) { side_ = side; }

  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override;

  /// From now on a tile comes only where release() lets it, in the order in which they were asked for. thread: main
  void hold();
  void release(int tiles);
  [[nodiscard]] int reads() const { return reads_; }

 private:
  [[nodiscard]] Color mean(double west_deg, double north_deg, double texel_deg) const;
  TileSetInfo info_;
  Paint paint_;
  Lacks missing_;
  int side_ = 1;
  std::mutex mutex_;
  std::condition_variable released_;
  bool held_ = false;
  int come_ = 0, let_through_ = 0;  ///< tiles asked for so far; of those, not held
  std::atomic<int> reads_ = 0;
};

/// A source whose every tile has one colour, encoded once.
[[nodiscard]] std::shared_ptr<TileSource> one_colour(const TileGrid& grid, const Color& color);

}  // namespace terrella::test
