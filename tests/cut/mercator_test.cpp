#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <span>

#include "cut_files.h"
#include "geo/body.h"
#include "streaming/convert/convert.h"
#include "streaming/cut/cut_plan.h"
#include "streaming/cut/mercator_plan.h"
#include "streaming/sets/open_tile_set.h"
#include "streaming/tile_lister.h"

namespace terrella::test {
namespace {

constexpr double kPi = std::numbers::pi;
/// Rounding to 8 bits in the picture and again in the tile, and the filter's overshoot in waves of 16 pixels.
constexpr double kColour_levels = 2.0;
/// A tenth of this would still show: the rounding of some 10^5 texels averages out.
constexpr double kPlace_px = 0.05;

constexpr double kWave_deg = 8.0;
double wave(double deg) { return 127.5 + 100.0 * std::sin(2.0 * kPi * deg / kWave_deg); }
/// Red waves along the parallel, green ones along the meridian.
double colour_at(double lat_deg, double lon_deg, int channel) {
  if (channel == 0) return wave(lon_deg);
  return channel == 1 ? wave(lat_deg) : 60.0;
}

/// A picture of pixels of `step` degrees, of the colours in the middle of its pixels.
Image painted_from(double west_deg, double north_deg, double step, int width_px, int height_px) {
  return painted(width_px, height_px, [&](int x, int y, int c) {
    if (c == 3) return 255;
    return static_cast<int>(std::lround(colour_at(north_deg - (y + 0.5) * step, west_deg + (x + 0.5) * step, c)));
  });
}

/// Latitude of a row of the square with `side` rows, counted from its northern end; spherical Mercator.
double row_lat_deg(double row, double side) {
  return std::atan(std::sinh(kPi * (1.0 - 2.0 * row / side))) * 180.0 / kPi;
}
/// Row of the square at a latitude.
double row_at(double lat_deg, double side) {
  return (1.0 - std::asinh(std::tan(lat_deg * kPi / 180.0)) / kPi) / 2.0 * side;
}

struct Texel {
  double lat_deg, lon_deg;
  std::span<const std::uint8_t> rgba;
};
/// Calls for each texel of the tiles that a level of a stored set has; `zoom` is the level's in the web pyramid.
template <class Call>
void for_each_texel(TileSource& set, int level, int zoom, const Call& call) {
  const TileGrid& grid = set.info().grid;
  const double side = std::ldexp(grid.tile_px, zoom);
  for (std::int64_t tile_y = 0; tile_y < rows(grid, level); ++tile_y) {
    for (std::int64_t tile_x = 0; tile_x < columns(grid, level); ++tile_x) {
      const TileId id{.level = level, .x = tile_x, .y = tile_y};
      // MBTiles states all longitudes for a picture across 180 degrees.
      if (!exists(grid, id) || !set.read(id)) continue;
      const Image tile = read_tile(set, id);
      for (std::size_t i = 0; i < tile.rgba.size() / 4; ++i) {
        const auto in_tile = static_cast<std::int64_t>(i);
        const std::int64_t x = tile_x * grid.tile_px + in_tile % grid.tile_px;
        const std::int64_t y = tile_y * grid.tile_px + in_tile / grid.tile_px;
        call(x, y,
             Texel{.lat_deg = row_lat_deg(static_cast<double>(y) + 0.5, side),
                   .lon_deg = (static_cast<double>(x) + 0.5) / side * 360.0 - 180.0,
                   .rgba = std::span(tile.rgba).subspan(4 * i, 4)});
      }
    }
  }
}

/// Expects the formula's colours in all opaque texels, and returns their number.
std::int64_t expect_colours(TileSource& set, int level, int zoom) {
  const double texel_deg = 360.0 / std::ldexp(set.info().grid.tile_px, zoom);
  double worst = 0.0;
  std::array<double, 2> by_slope{}, slopes{};  // along the parallel, along the meridian
  std::int64_t count = 0;
  for_each_texel(set, level, zoom, [&](auto, auto, const Texel& texel) {
    if (texel.rgba[3] != 255) return;
    ++count;
    const double row_deg = texel_deg * std::cos(texel.lat_deg * kPi / 180.0);
    for (int c = 0; c < 3; ++c) {
      const double at = c == 0 ? texel.lon_deg : texel.lat_deg;
      const double error = texel.rgba[static_cast<std::size_t>(c)] - colour_at(texel.lat_deg, texel.lon_deg, c);
      worst = std::max(worst, std::abs(error));
      if (c == 2) continue;
      const double slope =
          200.0 * kPi / kWave_deg * std::cos(2.0 * kPi * at / kWave_deg) * (c == 0 ? texel_deg : row_deg);
      by_slope[static_cast<std::size_t>(c)] += error * slope;
      slopes[static_cast<std::size_t>(c)] += slope * slope;
    }
  });
  EXPECT_LE(worst, kColour_levels) << "level " << level;
  for (const std::size_t c : {0U, 1U}) EXPECT_LE(std::abs(by_slope[c] / slopes[c]), kPlace_px) << "level " << level;
  return count;
}

class MercatorCut : public testing::Test {
 protected:
  /// Cuts a picture into the grid of Web Mercator, with tiles of PNG unless told otherwise, and opens the result.
  std::unique_ptr<TileSource> cut_into(
      const std::string& name, const Image& picture, std::optional<GeoRect> bounds,
      const std::function<void(CutOptions&)>& change = [](CutOptions&) {}) {
    write_png(folder_ / "in.png", picture);
    CutOptions options{.images = {folder_ / "in.png"},
                       .output = folder_ / name,
                       .grid = CutGrid::web_mercator,
                       .tile_px = 64,
                       .format = ImageFormat::png,
                       .bounds = bounds,
                       .remark = [this](const std::string& remark) { remarks_ += remark; }};
    change(options);
    if (!must_cut(options)) return {};
    auto set = open_stored_tile_set(options.output, false);
    EXPECT_TRUE(set) << set.error().message;
    return set ? *std::move(set) : nullptr;
  }

  static GeoRect degrees(double west, double south, double east, double north) {
    return {.west = Angle::degrees(west),
            .south = Angle::degrees(south),
            .east = Angle::degrees(east),
            .north = Angle::degrees(north)};
  }

  ScratchFolder folder_;
  std::string remarks_;
};

TEST_F(MercatorCut, PlanetHasTheColoursOfEachPlaceWithoutThePoles) {
  const auto set = cut_into("out.gpkg", painted_from(-180.0, 90.0, 0.5, 720, 360), {});
  ASSERT_TRUE(set);
  const TileGrid& grid = set->info().grid;
  EXPECT_EQ(grid.projection, Projection::web_mercator);
  EXPECT_EQ(grid.root_span_deg, 360.0);
  ASSERT_EQ(grid.max_level, 4) << "1024 texels of 0.35 degrees; 512 would be coarser than the picture";
  EXPECT_NEAR(grid.bounds.north.deg(), 85.0511287798, 1e-9);
  EXPECT_NEAR(grid.bounds.south.deg(), -85.0511287798, 1e-9);
  EXPECT_EQ(expect_colours(*set, 4, 4), 1024 * 1024);
  EXPECT_NE(remarks_.find("85.05"), std::string::npos) << remarks_;
}

TEST_F(MercatorCut, FinestLevelIsNoCoarserThanThePictureAtTheEquator) {
  struct Row {
    std::int64_t width;
    int tile_px, finest;
  };
  for (const Row& row : {Row{21600, 256, 7}, Row{16384, 256, 6}, Row{16386, 256, 7}, Row{256, 256, 0}, Row{258, 256, 1},
                         Row{512, 512, 0}, Row{86400, 256, 9}}) {
    const auto picture =
        plan_cut({.width_px = row.width, .height_px = row.width / 2}, {.images = {"a.png"}, .tile_px = row.tile_px});
    ASSERT_TRUE(picture) << picture.error().message;
    const auto plan = mercator_plan(*picture, earth().ellipsoid, false, "a.png");
    ASSERT_TRUE(plan) << plan.error().message;
    EXPECT_EQ(plan->grid.max_level, row.finest) << row.width;
  }
}

TEST_F(MercatorCut, CoarserTexelsAreMeansByArea) {
  const auto set = cut_into("out.gpkg", noise(32, 16), {}, [](CutOptions& options) { options.tile_px = 16; });
  ASSERT_TRUE(set);
  ASSERT_EQ(set->info().grid.max_level, 1);
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::uint8_t>> finest;
  for_each_texel(*set, 1, 1, [&](std::int64_t x, std::int64_t y, const Texel& texel) {
    finest[{x, y}].assign(texel.rgba.begin(), texel.rgba.end());
  });
  const auto area = [](std::int64_t y) {
    const auto sine = [](double row) { return std::tanh(kPi * (1.0 - row / 16.0)); };  // sine of the latitude
    return sine(static_cast<double>(y)) - sine(static_cast<double>(y + 1));
  };
  double worst = 0.0;
  for_each_texel(*set, 0, 0, [&](std::int64_t x, std::int64_t y, const Texel& texel) {
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (const std::int64_t row : {2 * y, 2 * y + 1}) {
        sum += area(row) * (finest[{2 * x, row}][c] + finest[{2 * x + 1, row}][c]) / 2.0;
      }
      worst = std::max(worst, std::abs(texel.rgba[c] - sum / (area(2 * y) + area(2 * y + 1))));
    }
  });
  constexpr double kRounding = 0.501;  // to 8 bits, once
  EXPECT_LE(worst, kRounding);
}

/// Part of [from, to] in [at, at + 1].
double part_in(double at, double from, double to) {
  return std::clamp(std::min(at + 1.0, to) - std::max(at, from), 0.0, 1.0);
}

TEST_F(MercatorCut, RegionHasAlphaByTheCoveredPartOfATexel) {
  // Its edges are no texels' edges.
  const auto set = cut_into("out.gpkg", painted_from(5.2, 49.3, 0.1, 123, 61), degrees(5.2, 43.2, 17.5, 49.3));
  ASSERT_TRUE(set);
  ASSERT_EQ(set->info().grid.max_level, 6);
  EXPECT_GT(expect_colours(*set, 6, 6), 123 * 61);
  const double side = 64.0 * 64.0;
  const double west = (5.2 + 180.0) / 360.0 * side, east = (17.5 + 180.0) / 360.0 * side;
  const double north = row_at(49.3, side), south = row_at(43.2, side);
  double worst = 0.0;
  for_each_texel(*set, 6, 6, [&](std::int64_t x, std::int64_t y, const Texel& texel) {
    const double part = part_in(static_cast<double>(x), west, east) * part_in(static_cast<double>(y), north, south);
    worst = std::max(worst, std::abs(texel.rgba[3] - 255.0 * part));
  });
  constexpr double kAlpha_levels = 1.0;  // rounding, and texels under half a level, which are left out
  EXPECT_LE(worst, kAlpha_levels);
  EXPECT_EQ(remarks_, "");
}

TEST_F(MercatorCut, PictureAcross180GoesOnAtTheFirstColumn) {
  const auto set = cut_into("out.gpkg", painted_from(170.0, 10.0, 0.25, 120, 80), degrees(170.0, -10.0, -160.0, 10.0));
  ASSERT_TRUE(set);
  const TileGrid& grid = set->info().grid;
  EXPECT_EQ(grid.root_span_deg, 180.0) << "its sides meet in no tile";
  EXPECT_LT(grid.bounds.east, grid.bounds.west);
  EXPECT_GT(expect_colours(*set, grid.max_level, grid.max_level + 1), 120 * 80);
  const auto web =
      cut_into("out.mbtiles", painted_from(170.0, 10.0, 0.25, 120, 80), degrees(170.0, -10.0, -160.0, 10.0));
  ASSERT_TRUE(web);
  EXPECT_GT(expect_colours(*web, web->info().grid.max_level, grid.max_level + 1), 120 * 80);
}

TEST_F(MercatorCut, PictureAcross180And0IsOneOfAllLongitudesWithAGap) {
  const auto set = cut_into("out.pmtiles", painted_from(80.0, 20.0, 0.25, 1160, 160), degrees(80.0, -20.0, 10.0, 20.0));
  ASSERT_TRUE(set);
  const int level = set->info().grid.max_level;
  EXPECT_EQ(set->info().grid.root_span_deg, 360.0);
  EXPECT_GT(expect_colours(*set, level, level), 1160 * 160);
  for_each_texel(*set, level, level, [](auto, auto, const Texel& texel) {
    const bool in_gap = texel.lon_deg > 11.0 && texel.lon_deg < 79.0;
    EXPECT_TRUE(!in_gap || texel.rgba[3] == 0) << texel.lon_deg;
  });
}

TEST_F(MercatorCut, LatitudesOfAnotherKindAndEqualAreasComeToTheirPlace) {
  // Rows of equal areas: the picture's colours are those of the places.
  const Image equal_area = painted(720, 360, [](int x, int y, int c) {
    if (c == 3) return 255;
    const double lat_deg = std::asin(1.0 - (y + 0.5) / 180.0) * 180.0 / kPi;
    return static_cast<int>(std::lround(c == 1 ? 127.5 + lat_deg : colour_at(0.0, -180.0 + (x + 0.5) / 2.0, c)));
  });
  const auto set = cut_into("out.gpkg", equal_area, {}, [](CutOptions& options) {
    options.projection = Projection::equal_area;
    options.body = "1000000,0";
  });
  ASSERT_TRUE(set);
  double worst = 0.0;
  for_each_texel(*set, 4, 4, [&](auto, auto, const Texel& texel) {
    if (std::abs(texel.lat_deg) < 80.0) worst = std::max(worst, std::abs(texel.rgba[1] - 127.5 - texel.lat_deg));
  });
  EXPECT_LE(worst, 1.0);
  // Planetocentric rows on a body of flattening 1/10.
  const Image centric = painted(720, 360, [](int, int y, int c) {
    const double lat_deg = std::atan(std::tan((90.0 - (y + 0.5) / 2.0) * kPi / 180.0) / 0.81) * 180.0 / kPi;
    return c == 3 ? 255 : static_cast<int>(std::lround(127.5 + lat_deg));
  });
  const auto flat = cut_into("flat.gpkg", centric, {}, [](CutOptions& options) {
    options.latitude = LatitudeKind::centric;
    options.body = "1000000,0.1";
  });
  ASSERT_TRUE(flat);
  worst = 0.0;
  for_each_texel(*flat, 4, 4, [&](auto, auto, const Texel& texel) {
    worst = std::max(worst, std::abs(texel.rgba[1] - 127.5 - texel.lat_deg));
  });
  EXPECT_LE(worst, 1.0);
}

std::map<TileId, std::vector<std::byte>> stored_tiles(TileSource& set) {
  std::map<TileId, std::vector<std::byte>> tiles;
  auto* const lister = dynamic_cast<TileLister*>(&set);
  EXPECT_TRUE(lister != nullptr);
  if (lister == nullptr) return tiles;
  EXPECT_TRUE(lister->for_each_tile([&](const TileId& id) {
    auto tile = set.read(id);
    EXPECT_TRUE(tile);
    if (tile) tiles[id] = std::move(tile->bytes);
    return true;
  }));
  return tiles;
}

TEST_F(MercatorCut, EveryFormatHoldsTheTilesThatConvertWouldWrite) {
  const auto default_format = [](CutOptions& options) { options.format.reset(); };
  const Image region = painted_from(5.2, 49.3, 0.1, 123, 61);
  const GeoRect bounds = degrees(5.2, 43.2, 17.5, 49.3);
  const auto set = cut_into("out.gpkg", region, bounds, default_format);
  ASSERT_TRUE(set);
  const auto expected = stored_tiles(*set);
  EXPECT_GT(expected.size(), 10U);
  ASSERT_TRUE(convert({.from = folder_ / "out.gpkg", .to = folder_ / "converted.pmtiles"}));
  const auto converted = open_stored_tile_set(folder_ / "converted.pmtiles", false);
  const auto direct = cut_into("out.pmtiles", region, bounds, default_format);
  ASSERT_TRUE(converted && direct);
  EXPECT_TRUE(stored_tiles(**converted) == expected);
  EXPECT_TRUE(stored_tiles(*direct) == expected) << "JPEG, and PNG at the outline";
  EXPECT_EQ(direct->info().grid, (*converted)->info().grid);
  const auto mbtiles = cut_into("out.mbtiles", region, bounds, default_format);
  ASSERT_TRUE(mbtiles);
  EXPECT_EQ(mbtiles->info().format, ImageFormat::png) << "it has one format";
  for (const auto& [id, bytes] : stored_tiles(*mbtiles)) EXPECT_EQ(sniff_format(bytes), ImageFormat::png);
  const auto planet = cut_into("planet.mbtiles", painted_from(-180.0, 90.0, 2.0, 180, 90), {}, default_format);
  ASSERT_TRUE(planet);
  EXPECT_EQ(planet->info().format, ImageFormat::jpeg);
  for (const auto& [id, bytes] : stored_tiles(*planet)) EXPECT_EQ(sniff_format(bytes), ImageFormat::jpeg);
}

TEST_F(MercatorCut, RefusesWhatCannotBeAndNamesACure) {
  write_png(folder_ / "in.png", noise(64, 32));
  CutOptions options{.images = {folder_ / "in.png"}, .output = folder_ / "out.pmtiles", .tile_px = 64};
  expect_refused(options, {"out.pmtiles", "‹grid› webmercator", ".gpkg"});
  options.grid = CutGrid::web_mercator;
  options.bounds = degrees(0.0, 86.0, 6.0, 89.0);
  expect_refused(options, {"in.png", "85.05", "leave ‹grid› out", ".gpkg"});
  options.bounds.reset();
  options.tile_px = 2048;
  expect_refused(options, {"‹tile_px›", "1024"});
}

TEST_F(MercatorCut, ShardsJoinToTheSameBytes) {
  const Image picture = noise(256, 128);
  const auto change = [](CutOptions& options) { options.tile_px = 16; };
  ASSERT_TRUE(cut_into("whole.pmtiles", picture, {}, change));
  CutOptions options{.images = {folder_ / "in.png"},
                     .output = folder_ / "out.pmtiles",
                     .grid = CutGrid::web_mercator,
                     .tile_px = 16,
                     .format = ImageFormat::png};
  for (const int index : {2, 1}) {
    options.shard = CutShard{index, 2};
    ASSERT_TRUE(must_cut(options));
  }
  options.shard.reset();
  options.join = true;
  ASSERT_TRUE(must_cut(options));
  EXPECT_TRUE(read_bytes(folder_ / "out.pmtiles") == read_bytes(folder_ / "whole.pmtiles"));
}

}  // namespace
}  // namespace terrella::test
