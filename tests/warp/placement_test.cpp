// Tiles of rasters in any projection: where they show things, and how sharp. The truth is a function of the place; the
// raster is painted through PROJ's way from pixels to places, the tiles are made through the opposite one.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "painted_raster.h"
#include "streaming/warp/warp_source.h"

namespace terrella {
namespace {

using test::PaintedOptions;
using test::PaintedRaster;

/// Largest misplacement of a tile's content, source pixels.
constexpr double kPlacement_px = 0.05;
/// Waves of 12 pixels and 100 levels: a cubic keeps 98 % of them.
constexpr double kWarpedWaveRms = 3.0;

struct Case {
  const char* name;
  PaintedOptions raster;
  double lat_deg, lon_deg;  ///< a place in the tile
  int coarser;              ///< levels of the grid
  double wave_px = 12.0;    ///< longer where the projection shears waves to less than that in the raster
};
void PrintTo(const Case& given, std::ostream* out) { *out << given.name; }

constexpr double kDegree_m = 6378137.0 * std::numbers::pi / 180.0;

Affine north_up(double west, double north, double pixel) { return {west, pixel, 0.0, north, 0.0, -pixel}; }

PaintedOptions raster(const char* crs, const Affine& to_crs, std::int64_t width, std::int64_t height,
                      int overviews = 0) {
  return {.crs = crs, .to_crs = to_crs, .width_px = width, .height_px = height, .overviews = overviews};
}

/// A wave along a direction on the tile's plane of degrees.
struct Wave {
  double lat_per_period_deg, lon_per_period_deg;
  [[nodiscard]] double at(double lat, double lon) const {
    return 127.5 + 100.0 * std::sin(2.0 * std::numbers::pi *
                                    ((lat_per_period_deg > 0.0 ? lat / lat_per_period_deg : 0.0) +
                                     (lon_per_period_deg > 0.0 ? lon / lon_per_period_deg : 0.0)));
  }
};

class WarpPlaces : public testing::TestWithParam<Case> {};

TEST_P(WarpPlaces, ShowThingsWhereTheyAre) {
  const Case& given = GetParam();
  const Ellipsoid sphere(6378137.0, 0.0);
  const WarpOptions options{.figure = {.ellipsoid = sphere}, .body = "sphere", .tile_px = 64};
  const auto grid = warp_grid(PaintedRaster(given.raster, {}, {}).info(), options, "the raster");
  ASSERT_TRUE(grid) << grid.error().message;
  const int level = grid->max_level - given.coarser;
  const TileXY xy = tile_xy(*grid, level, given.lat_deg, given.lon_deg);
  const TileId id{level, static_cast<std::int64_t>(xy.x), static_cast<std::int64_t>(xy.y)};
  ASSERT_TRUE(exists(*grid, id));
  const double step = tile_span_deg(*grid, level) / grid->tile_px;
  // As long on the ground both ways, and whole periods around the planet.
  const double cosine = std::max(std::cos(given.lat_deg * std::numbers::pi / 180.0), 0.02);
  const Wave by_lat{given.wave_px * step, 0.0};
  const Wave by_lon{0.0, 360.0 / std::max(1.0, std::round(360.0 * cosine / (given.wave_px * step)))};
  const auto tiles = warp_source(std::make_unique<PaintedRaster>(
                                     given.raster, [&](double lat, double lon) { return by_lat.at(lat, lon); },
                                     [&](double lat, double lon) { return by_lon.at(lat, lon); }),
                                 options, "the raster");
  ASSERT_TRUE(tiles) << tiles.error().message;
  const auto tile = (*tiles)->read(id);
  ASSERT_TRUE(tile) << tile.error().why;
  const auto made = tile->make_picture();
  ASSERT_TRUE(made) << made.error().why;
  const TileBounds bounds = tile_bounds(*grid, id);
  for (const bool north_south : {true, false}) {
    double product = 0.0, square = 0.0, error = 0.0;
    int pixels = 0;
    for (int j = 0; j < made->height_px; ++j) {
      for (int i = 0; i < made->width_px; ++i) {
        const std::size_t at = static_cast<std::size_t>(j * made->width_px + i) * 4;
        if (made->rgba[at + 3] < 255) continue;
        const double lat = bounds.north_deg - (j + 0.5) * step, lon = bounds.west_deg + (i + 0.5) * step;
        if (lat < -90.0) continue;  // rows beyond the pole repeat the last
        const auto value = [&](double move) {
          return north_south ? by_lat.at(lat + move * step, lon) : by_lon.at(lat, lon + move * step / cosine);
        };
        const double slope = value(0.5) - value(-0.5);
        const double difference = made->rgba[at + (north_south ? 0 : 1)] - value(0.0);
        product += difference * slope;
        square += slope * slope;
        error += difference * difference;
        ++pixels;
      }
    }
    ASSERT_GT(pixels, 200) << "almost nothing is drawn";
    EXPECT_LE(std::abs(product / square), kPlacement_px) << (north_south ? "north to south" : "west to east");
    EXPECT_LE(std::sqrt(error / pixels), kWarpedWaveRms) << (north_south ? "north to south" : "west to east");
  }
}

const double kPixel_m = kDegree_m * 0.25;

INSTANTIATE_TEST_SUITE_P(
    Everywhere, WarpPlaces,
    testing::Values(
        Case{"sinusoidal",
             raster("+proj=sinu +R=6378137", north_up(-180 * kDegree_m, 90 * kDegree_m, kPixel_m), 1440, 720), 40.0,
             20.0, 0},
        Case{"sinusoidal_at_180",
             raster("+proj=sinu +R=6378137", north_up(-180 * kDegree_m, 90 * kDegree_m, kPixel_m), 1440, 720), -35.0,
             179.0, 0},
        Case{"sinusoidal_overview",
             raster("+proj=sinu +R=6378137", north_up(-180 * kDegree_m, 90 * kDegree_m, kPixel_m), 1440, 720, 3), 20.0,
             -60.0, 2},
        Case{
            "sinusoidal_of_0_to_360",
            raster("+proj=sinu +lon_0=180 +R=6378137", north_up(-180 * kDegree_m, 90 * kDegree_m, kPixel_m), 1440, 720),
            30.0, -3.0, 0, 24.0},
        Case{"polar_stereographic",
             raster("+proj=stere +lat_0=90 +R=6378137", north_up(-30 * kDegree_m, 30 * kDegree_m, kPixel_m), 240, 240),
             70.0, 33.0, 0},
        Case{"polar_stereographic_at_the_pole",
             raster("+proj=stere +lat_0=-90 +R=6378137", north_up(-30 * kDegree_m, 30 * kDegree_m, kPixel_m), 240, 240),
             -89.0, -100.0, 0},
        Case{"transverse_mercator",
             raster("+proj=utm +zone=32 +datum=WGS84", north_up(200000, 5300000, 1000.0), 600, 500), 46.0, 9.5, 0},
        Case{"lambert",
             raster("+proj=lcc +lat_1=33 +lat_2=45 +lat_0=39 +lon_0=-96 +R=6378137",
                    north_up(-2500000, 1500000, 10000.0), 500, 300),
             40.0, -110.0, 0},
        Case{"mercator",
             raster("+proj=merc +R=6378137", north_up(-180 * kDegree_m, 180 * kDegree_m, kPixel_m), 1440, 1440), 47.0,
             179.0, 0},
        Case{"plate_carree_from_0",
             raster("+proj=eqc +lon_0=180 +R=6378137", north_up(-180 * kDegree_m, 90 * kDegree_m, kPixel_m), 1440, 720),
             10.0, -0.5, 0},
        Case{"plate_carree_of_0_to_360",
             raster("+proj=eqc +R=6378137", north_up(0, 90 * kDegree_m, kPixel_m), 1440, 720), 10.0, -0.5, 0},
        Case{"plate_carree_off_the_grid",
             raster("+proj=eqc +R=6378137", north_up(-179.9 * kDegree_m, 89.93 * kDegree_m, kPixel_m), 1440, 720), 10.0,
             -179.5, 0},
        Case{"plate_carree_of_180_01",
             raster("+proj=eqc +R=6378137", north_up(-180.01 * kDegree_m, 90.01 * kDegree_m, kPixel_m), 1441, 721),
             10.0, 179.5, 0},
        Case{"plate_carree_with_a_parallel",
             raster("+proj=eqc +lat_ts=60 +R=6378137", north_up(-90 * kDegree_m, 90 * kDegree_m, kPixel_m), 720, 720),
             50.0, 20.0, 0},
        Case{"rotated",
             raster("+proj=eqc +R=6378137",
                    {10 * kDegree_m, 0.2 * kDegree_m, 0.15 * kDegree_m, 50 * kDegree_m, 0.15 * kDegree_m,
                     -0.2 * kDegree_m},
                    400, 300),
             40.0, 70.0, 0},
        Case{"orthographic",
             raster("+proj=ortho +lat_0=20 +lon_0=170 +R=6378137", north_up(-60 * kDegree_m, 60 * kDegree_m, kPixel_m),
                    480, 480),
             25.0, -179.0, 0},
        Case{
            "upside_down",
            raster("+proj=merc +R=6378137", {-50 * kDegree_m, kPixel_m, 0.0, -50 * kDegree_m, 0.0, kPixel_m}, 400, 400),
            20.0, 10.0, 0}),
    [](const auto& given) { return std::string(given.param.name); });

TEST(WarpPlanet, TilesOfAnOpaquePlanetAreOpaqueBeyondThePole) {
  // 264 pixels round the planet: tiles reach beyond the south pole and beyond 180 degrees, and the pole cuts off a part
  // of the last row of coarse levels.
  const double pixel_m = kDegree_m * 360.0 / 264.0;
  PaintedOptions planet =
      raster("+proj=eqc +R=6378137", north_up(-180 * kDegree_m, 90 * kDegree_m, pixel_m), 264, 132, 2);
  planet.rays = 1;
  const auto plain = [](double, double) { return 200.0; };
  const WarpOptions options{.figure = {.ellipsoid = Ellipsoid(6378137.0, 0.0)}, .body = "sphere", .tile_px = 32};
  const auto tiles = warp_source(std::make_unique<PaintedRaster>(planet, plain, plain), options, "the planet");
  ASSERT_TRUE(tiles) << tiles.error().message;
  const TileGrid& grid = (*tiles)->info().grid;
  ASSERT_GE(grid.max_level, 3);
  for (int level = 0; level <= 3; ++level) {
    const TileXY corner = tile_xy(grid, level, -90.0, 180.0);
    for (const double x : {0.0, corner.x}) {
      const TileId id{level, static_cast<std::int64_t>(x - 1e-9), static_cast<std::int64_t>(corner.y - 1e-9)};
      const auto tile = (*tiles)->read(id);
      ASSERT_TRUE(tile) << tile.error().why;
      const auto made = tile->make_picture();
      ASSERT_TRUE(made) << made.error().why;
      for (std::size_t at = 3; at < made->rgba.size(); at += 4) {
        ASSERT_EQ(made->rgba[at], 255) << "level " << level << ", column " << id.x << ", pixel " << at / 4;
      }
    }
  }
}

}  // namespace
}  // namespace terrella
