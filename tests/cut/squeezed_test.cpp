#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "codecs/image.h"
#include "cut_files.h"
#include "picture_files.h"
#include "streaming/cut.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella::test {
namespace {

constexpr int kWaves = 8;
constexpr double kAmplitude = 100.0;

// Value of a wave along the parallel at a longitude, in 8-bit levels.
double wave_at(double lon_deg) { return 128.0 + kAmplitude * std::sin(kWaves * lon_deg * std::numbers::pi / 180.0); }

Image waves(int width_px, int height_px) {
  return painted(width_px, height_px, [width_px](int x, int, int c) {
    return c == 3 ? 255 : static_cast<int>(std::lround(wave_at(360.0 * (x + 0.5) / width_px - 180.0)));
  });
}

struct WaveCut {
  ScratchFolder folder;
  std::unique_ptr<TileSource> tiles;
};

std::unique_ptr<WaveCut> cut_waves(int width_px, const char* output) {
  auto made = std::make_unique<WaveCut>();
  write_png(made->folder / "in.png", waves(width_px, width_px / 2));
  CutOptions options{.images = {made->folder / "in.png"}, .output = made->folder / output, .tile_px = 16};
  options.format = ImageFormat::png;
  const auto summary = cut(options);
  EXPECT_TRUE(summary) << (summary ? "" : summary.error().message);
  auto tiles = open_tile_set(options.output);
  if (tiles) made->tiles = *std::move(tiles);
  return made;
}

// Largest difference from the wave over a tile's pixels on this side of +180°.
double worst_in(TileSource& tiles, const TileId& id) {
  const auto encoded = tiles.read(id);
  EXPECT_TRUE(encoded) << "level " << id.level << " row " << id.y << " column " << id.x;
  if (!encoded) return 1e9;
  const auto image = decode_image(encoded->bytes);
  EXPECT_TRUE(image);
  const TileBounds bounds = tile_bounds(tiles.info().grid, id);
  const double pixel_deg = (bounds.east_deg - bounds.west_deg) / image->width_px;
  double worst = 0.0;
  for (int x = 0; x < image->width_px; ++x) {
    const double lon = bounds.west_deg + (x + 0.5) * pixel_deg;
    if (lon + pixel_deg > 180.0) break;
    const int got = image->rgba[static_cast<std::size_t>((7 * image->width_px + x) * 4)];
    worst = std::max(worst, std::abs(got - wave_at(lon)));
  }
  return worst;
}

struct SqueezedCase {
  int width_px;
  const char* output;
  friend void PrintTo(const SqueezedCase& one, std::ostream* out) { *out << one.width_px << " to " << one.output; }
};
class SqueezedTiles : public testing::TestWithParam<SqueezedCase> {};

// A wave that is 16 squeezed pixels long at the least keeps its height to 1 % of 100 levels, and two roundings; shifted
// by half a squeezed pixel it would be off by 19. Coarser levels are means, of which 8 pixels a wave keep 0.95.
TEST_P(SqueezedTiles, HoldTheSamePictureInFewerColumns) {
  constexpr double kFinest = 2.0, kCoarser = 6.0;
  const auto made = cut_waves(GetParam().width_px, GetParam().output);
  ASSERT_TRUE(made->tiles);
  const TileGrid& grid = made->tiles->info().grid;
  ASSERT_TRUE(grid.reduced);
  int rows_seen = 0;
  for (int level = 0; level <= grid.max_level; ++level) {
    for (std::int64_t y = 0; y < rows(grid, level); ++y) {
      const int squeeze = squeeze_of_row(grid, level, y);
      if (squeeze == 0) continue;
      ++rows_seen;
      for (std::int64_t x = 0; x < squeezed_columns(grid, level, squeeze); ++x) {
        const double most = level == grid.max_level ? kFinest : kCoarser;
        ASSERT_LE(worst_in(*made->tiles, {level, x, y, squeeze}), most) << "level " << level << " row " << y;
      }
    }
  }
  EXPECT_GE(rows_seen, 4);
}

INSTANTIATE_TEST_SUITE_P(Sets, SqueezedTiles,
                         testing::Values(SqueezedCase{512, "out.gpkg"}, SqueezedCase{512, "out"},
                                         SqueezedCase{540, "out.gpkg"}));

TEST(SqueezedTilesTest, AreNotMadeOfAPartOfThePlanetNorOfHeights) {
  ScratchFolder folder;
  write_png(folder / "in.png", waves(256, 64));
  CutOptions options{.images = {folder / "in.png"}, .output = folder / "out.gpkg", .tile_px = 16};
  options.bounds = GeoRect{.west = Angle::degrees(0),
                           .south = Angle::degrees(67.5),
                           .east = Angle::degrees(90),
                           .north = Angle::degrees(90)};
  ASSERT_TRUE(cut(options));
  const auto tiles = open_tile_set(options.output);
  ASSERT_TRUE(tiles);
  EXPECT_FALSE((*tiles)->info().grid.reduced);
}

}  // namespace
}  // namespace terrella::test
