#include "tests/gl/painted_numbers.h"

#include <utility>

namespace terrella::test {

PaintedNumbers::PaintedNumbers(const TileGrid& grid, Paint paint, const NumberInfo& meaning)
    : paint_(std::move(paint)) {
  info_.grid = grid;
  info_.format = ImageFormat::png;
  info_.numbers = meaning;
}

Result<EncodedTile, TileFailure> PaintedNumbers::read(const TileId& id) {
  ++reads_;
  if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside"};
  EncodedTile tile;
  tile.make_numbers = [grid = info_.grid, id, paint = paint_]() -> Result<Numbers, TileFailure> {
    const TileBounds b = tile_bounds(grid, id);
    const int side = grid.tile_px;
    Numbers numbers{.width_px = side, .height_px = side, .values = {}};
    for (int k = 0; k < side * side; ++k) {
      numbers.values.push_back(paint(b.west_deg + (k % side + 0.5) * (b.east_deg - b.west_deg) / side,
                                     b.north_deg - (k / side + 0.5) * (b.north_deg - b.south_deg) / side));
    }
    return numbers;
  };
  return tile;
}

}  // namespace terrella::test
