#include "tests/gl/layer_source.h"

#include <algorithm>
#include <utility>

namespace terrella::test {

LayerSource::LayerSource(const TileGrid& grid, Paint paint, Lacks lacks)
    : paint_(std::move(paint)), missing_(std::move(lacks)) {
  info_.grid = grid;
  info_.format = ImageFormat::png;
}

Result<EncodedTile, TileFailure> LayerSource::read(const TileId& id) {
  if (!exists(info_.grid, id) || (missing_ && missing_(id))) return TileFailure{MissingKind::absent, "not there"};
  const int side = info_.grid.tile_px;
  const TileBounds bounds = tile_bounds(info_.grid, id);
  const double texel_deg = (bounds.east_deg - bounds.west_deg) / side;  // wider than a row in a squeezed tile
  const double row_deg = (bounds.north_deg - bounds.south_deg) / side;
  Image image{side, side, {}};
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const Rgba color = paint_(bounds.west_deg + (x + 0.5) * texel_deg, bounds.north_deg - (y + 0.5) * row_deg);
      image.rgba.insert(image.rgba.end(), color.begin(), color.end());
    }
  }
  return EncodedTile{*encode_png(image)};
}

}  // namespace terrella::test
