#include "tests/gl/painted_heights.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "streaming/cut/output/gray16_png.h"

namespace terrella::test {
namespace {

constexpr double kStep_m = 0.25, kLowest_m = -8192.0;

class PaintedHeights : public TileSource {
 public:
  PaintedHeights(const TileGrid& grid, HeightPaint paint) : paint_(std::move(paint)) {
    info_.grid = grid;
    info_.format = ImageFormat::png;
    info_.numbers = NumberInfo{.scale = kStep_m, .offset = kLowest_m, .nodata = {}, .floats = false};
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside"};
    const TileBounds b = tile_bounds(info_.grid, id);
    const int side = info_.grid.tile_px;
    const double pixel_deg = (b.east_deg - b.west_deg) / side, to_rad = std::numbers::pi / 180.0;
    std::vector<std::uint16_t> values;
    for (int k = 0; k < side * side; ++k) {
      const double lat = (b.north_deg - (k / side + 0.5) * pixel_deg) * to_rad,
                   lon = (b.west_deg + (k % side + 0.5) * pixel_deg) * to_rad;
      values.push_back(static_cast<std::uint16_t>(std::lround((paint_(lat, lon) - kLowest_m) / kStep_m)));
    }
    return EncodedTile{*encode_gray16_png(values, side)};
  }

 private:
  TileSetInfo info_;
  HeightPaint paint_;
};

}  // namespace

std::shared_ptr<TileSource> painted_heights(const TileGrid& grid, HeightPaint paint) {
  return std::make_shared<PaintedHeights>(grid, std::move(paint));
}

}  // namespace terrella::test
