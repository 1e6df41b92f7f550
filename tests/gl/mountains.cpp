#include "tests/gl/mountains.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "streaming/cut/output/gray16_png.h"

namespace terrella::test {
namespace {

const TileGrid kHeightGrid{.tile_px = 64, .max_level = 3};

}  // namespace

double mountain_m(double lat_rad, double lon_rad, double waves) {
  return 0.5 * kMost_m * (std::sin(waves * lat_rad) + std::cos(waves * lon_rad) * std::cos(lat_rad));
}

Mountains::Mountains(double waves) : waves_(waves) {
  info_.grid = kHeightGrid;
  info_.format = ImageFormat::png;
  info_.numbers = NumberInfo{.scale = 0.25, .offset = -8192.0, .nodata = {}, .floats = false};
}

Result<EncodedTile, TileFailure> Mountains::read(const TileId& id) {
  if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside"};
  const TileBounds b = tile_bounds(info_.grid, id);
  const int side = info_.grid.tile_px;
  const double pixel_deg = (b.east_deg - b.west_deg) / side, to_rad = std::numbers::pi / 180.0;
  std::vector<std::uint16_t> values;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double lat = (b.north_deg - (y + 0.5) * pixel_deg) * to_rad,
                   lon = (b.west_deg + (x + 0.5) * pixel_deg) * to_rad;
      values.push_back(static_cast<std::uint16_t>(std::lround(4.0 * (mountain_m(lat, lon, waves_) + 8192.0))));
    }
  }
  return EncodedTile{*encode_gray16_png(values, side)};
}

std::unique_ptr<Globe> mountainous_globe(const GlobeOptions& options, std::shared_ptr<TileSource> imagery,
                                         double waves) {
  auto heights = ElevationSource::open(std::make_shared<Mountains>(waves), "mountains");
  EXPECT_TRUE(heights) << (heights ? "" : heights.error().message);
  // A test looks at the picture that is finished: as much as has come is made in one frame.
  GlobeOptions at_once = options;
  at_once.relief_meshes_per_frame = std::numeric_limits<int>::max();
  auto globe = Globe::create(at_once, std::move(imagery), *heights);
  EXPECT_TRUE(globe);
  return std::move(*globe);
}

}  // namespace terrella::test
