// Rasters that end, fail or are odd: what is transparent, what is missing, what is refused.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "painted_raster.h"
#include "streaming/warp/warp_source.h"
#include "tiles/height_decoder.h"

namespace terrella {
namespace {

using test::PaintedOptions;
using test::PaintedRaster;

constexpr double kDeg_m = 6378137.0 * std::numbers::pi / 180.0;

double plain(double, double) { return 200.0; }
double by_latitude(double lat, double) { return 127.5 + lat; }

WarpOptions on_sphere(int tile_px = 64) {
  return {.figure = {.ellipsoid = Ellipsoid(6378137.0, 0.0)}, .body = "sphere", .tile_px = tile_px};
}

PaintedOptions degrees(double west, double north, double pixel, std::int64_t width, std::int64_t height) {
  return {.crs = "+proj=longlat +R=6378137",
          .to_crs = {west, pixel, 0.0, north, 0.0, -pixel},
          .width_px = width,
          .height_px = height,
          .rays = 1};
}

std::unique_ptr<TileSource> warped(std::unique_ptr<RasterSource> raster, int tile_px = 64) {
  auto tiles = warp_source(std::move(raster), on_sphere(tile_px), "the raster");
  EXPECT_TRUE(tiles) << (tiles ? "" : tiles.error().message);
  return *std::move(tiles);
}

TileId tile_over(const TileGrid& grid, int level, double lat, double lon) {
  const TileXY at = tile_xy(grid, level, lat, lon);
  return {level, static_cast<std::int64_t>(at.x), static_cast<std::int64_t>(at.y)};
}

Result<Image, TileFailure> drawn_tile(TileSource& tiles, const TileId& id) {
  auto tile = tiles.read(id);
  if (!tile) return tile.error();
  return tile->make_picture();
}

TEST(WarpGrid, IsTheRastersOwnWhereItFits) {
  for (const double west : {-180.0, 0.0, -90.0}) {
    const auto grid = warp_grid(PaintedRaster(degrees(west, 90.0, 0.5, 720, 360), {}, {}).info(), on_sphere(), "it");
    ASSERT_TRUE(grid);
    EXPECT_NEAR(tile_span_deg(*grid, grid->max_level) / grid->tile_px, 0.5, 1e-12);
    EXPECT_NEAR(grid->bounds.west.deg(), -180.0, 1e-9);
    EXPECT_NEAR(grid->bounds.east.deg(), 180.0, 1e-9);
    EXPECT_NEAR(grid->bounds.north.deg(), 90.0, 1e-9);
  }
  const auto part = warp_grid(PaintedRaster(degrees(170.0, 30.0, 0.25, 80, 40), {}, {}).info(), on_sphere(), "it");
  ASSERT_TRUE(part);
  EXPECT_NEAR(part->bounds.west.deg(), 170.0, 1e-9);
  EXPECT_NEAR(part->bounds.east.deg(), -170.0, 1e-9) << "it crosses 180°";
  EXPECT_NEAR(part->bounds.south.deg(), 20.0, 1e-9);
}

TEST(WarpGrid, AroundAPoleItHasAllLongitudes) {
  const PaintedOptions cap{.crs = "+proj=stere +lat_0=-90 +R=6378137",
                           .to_crs = {-1e6, 1e4, 0.0, 1e6, 0.0, -1e4},
                           .width_px = 200,
                           .height_px = 200};
  const auto grid = warp_grid(PaintedRaster(cap, {}, {}).info(), on_sphere(), "it");
  ASSERT_TRUE(grid);
  EXPECT_NEAR(grid->bounds.south.deg(), -90.0, 1e-9);
  EXPECT_NEAR(grid->bounds.west.deg(), -180.0, 1e-9);
  EXPECT_NEAR(grid->bounds.east.deg(), 180.0, 1e-9);
  // The corners lie 1414 km from the pole: 2 atan(d / 2R).
  EXPECT_NEAR(grid->bounds.north.deg(), -90.0 + 2.0 * std::atan(std::sqrt(2.0) * 1e6 / 2.0 / 6378137.0) / M_PI * 180.0,
              0.1);
}

TEST(WarpGrid, HasTheRastersPixelsThoughTheProjectionHasNoiseInTheMiddle) {
  // PROJ's Van der Grinten is wrong by a kilometre near its centre, where a degree has 1.8 pixels.
  const PaintedOptions planet{.crs = "+proj=vandg +R=6378137",
                              .to_crs = {-2.0015e7, 61867.0, 0.0, 2.0015e7, 0.0, -61867.0},
                              .width_px = 647,
                              .height_px = 647};
  const auto grid = warp_grid(PaintedRaster(planet, {}, {}).info(), on_sphere(), "it");
  ASSERT_TRUE(grid);
  EXPECT_NEAR(tile_span_deg(*grid, grid->max_level) / grid->tile_px, 61867.0 / kDeg_m, 0.02);
}

TEST(WarpGrid, FewPixelsOfAPlanetAreOneTile) {
  for (const int tile_px : {64, 256, 512}) {
    const auto grid =
        warp_grid(PaintedRaster(degrees(-180.0, 90.0, 90.0, 4, 2), {}, {}).info(), on_sphere(tile_px), "it");
    ASSERT_TRUE(grid) << grid.error().message;
    EXPECT_EQ(grid->max_level, 0);
  }
}

TEST(WarpGrid, TransformsOfNoUseAreRefused) {
  for (const double bad : {1e308, std::numeric_limits<double>::quiet_NaN(), 0.0}) {
    PaintedOptions options = degrees(0.0, 10.0, 1.0, 10, 10);
    options.to_crs.x_per_column = bad;
    const auto grid = warp_grid(PaintedRaster(options, {}, {}).info(), on_sphere(), "odd.tif");
    ASSERT_FALSE(grid);
    EXPECT_TRUE(grid.error().message.starts_with("odd.tif: its transform")) << grid.error().message;
  }
  PaintedOptions far_away = degrees(0.0, 1e6, 1.0, 10, 10);
  EXPECT_FALSE(warp_grid(PaintedRaster(far_away, {}, {}).info(), on_sphere(), "far.tif"));
  PaintedOptions unknown = degrees(0.0, 10.0, 1.0, 10, 10);
  unknown.crs = "+proj=nothing";
  EXPECT_FALSE(warp_grid(PaintedRaster(unknown, {}, {}).info(), on_sphere(), "odd.tif"));
}

TEST(Warp, PixelsOnTheGridAreCopied) {
  // Alphas that a weighted mean would not keep.
  class Translucent : public RasterSource {
   public:
    Translucent() {
      info_.crs = "+proj=longlat +R=6378137 +type=crs";
      info_.levels = {{.width_px = 360,
                       .height_px = 180,
                       .block_width_px = 90,
                       .block_height_px = 60,
                       .to_crs = {0.0, 1.0, 0.0, 90.0, 0.0, -1.0}}};
    }
    [[nodiscard]] const RasterInfo& info() const override { return info_; }
    [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
      EncodedTile tile;
      tile.make_picture = [id]() -> Result<Image, TileFailure> {
        Image image{90, 60, {}};
        for (int y = 0; y < 60; ++y) {
          for (int x = 0; x < 90; ++x) {
            const auto column = static_cast<std::uint8_t>((id.x * 90 + x) % 251);
            const auto row = static_cast<std::uint8_t>(id.y * 60 + y);
            image.rgba.insert(image.rgba.end(), {column, row, 77, static_cast<std::uint8_t>(3 + column % 9)});
          }
        }
        return image;
      };
      return tile;
    }

   private:
    RasterInfo info_;
  };
  const auto tiles = warped(std::make_unique<Translucent>());
  const TileGrid& grid = tiles->info().grid;
  const TileId id = tile_over(grid, grid.max_level, 20.0, -5.0);
  const auto made = drawn_tile(*tiles, id);
  ASSERT_TRUE(made);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const std::int64_t column = (id.x * 64 + x + 180) % 360, row = id.y * 64 + y;
      const std::uint8_t* at = &made->rgba[static_cast<std::size_t>(y * 64 + x) * 4];
      if (id.x * 64 + x >= 360 || row >= 180) continue;
      ASSERT_EQ(at[0], column % 251) << x << "," << y;
      ASSERT_EQ(at[1], row);
      ASSERT_EQ(at[2], 77);
      ASSERT_EQ(at[3], 3 + column % 251 % 9);
    }
  }
}

TEST(Warp, AlphaAtTheEdgeIsTheFractionCovered) {
  // Its west edge cuts pixels of the grid at three quarters, its north edge at a half.
  const auto tiles = warped(std::make_unique<PaintedRaster>(degrees(20.25, 49.5, 1.0, 20, 20), plain, plain));
  const TileGrid& grid = tiles->info().grid;
  const double step = tile_span_deg(grid, grid.max_level) / grid.tile_px;
  ASSERT_NEAR(step, 1.0, 1e-9);
  const TileId id = tile_over(grid, grid.max_level, 45.0, 22.0);
  const auto made = drawn_tile(*tiles, id);
  ASSERT_TRUE(made);
  const TileBounds bounds = tile_bounds(grid, id);
  const auto alpha = [&](double lat, double lon) {
    const int x = static_cast<int>(std::floor(lon - bounds.west_deg)),
              y = static_cast<int>(std::floor(bounds.north_deg - lat));
    return int{made->rgba[static_cast<std::size_t>(y * 64 + x) * 4 + 3]};
  };
  EXPECT_NEAR(alpha(45.5, 20.5), 0.75 * 255, 1.0);
  EXPECT_NEAR(alpha(49.5, 25.5), 0.5 * 255, 1.0);
  EXPECT_NEAR(alpha(49.5, 20.5), 0.375 * 255, 1.0);
  EXPECT_EQ(alpha(45.5, 19.5), 0);
  EXPECT_EQ(alpha(45.5, 22.5), 255);
}

TEST(Warp, WhereTheProjectionFailsItIsTransparent) {
  // A disc: half of the planet has no place on it, and the picture's corners no place on the planet.
  const PaintedOptions disc{.crs = "+proj=ortho +lat_0=0 +lon_0=0 +R=6378137",
                            .to_crs = {-6.5e6, 5e4, 0.0, 6.5e6, 0.0, -5e4},
                            .width_px = 260,
                            .height_px = 260,
                            .rays = 2};
  const auto tiles = warped(std::make_unique<PaintedRaster>(disc, plain, plain));
  const TileGrid& grid = tiles->info().grid;
  int drawn = 0, clear = 0;
  for (int level = 0; level <= 3; ++level) {
    const double step = tile_span_deg(grid, level) / grid.tile_px;
    for (std::int64_t y = 0; y < rows(grid, level); ++y) {
      for (std::int64_t x = 0; x < columns(grid, level); ++x) {
        const auto made = drawn_tile(*tiles, {level, x, y});
        const TileBounds bounds = tile_bounds(grid, {level, x, y});
        for (int k = 0; k < 64 * 64; ++k) {
          const double lat = bounds.north_deg - (k / 64 + 0.5) * step, lon = bounds.west_deg + (k % 64 + 0.5) * step;
          if (lat < -90.0 || lon > 180.0) continue;
          const double to_middle = std::cos(lat * M_PI / 180.0) * std::cos(lon * M_PI / 180.0);
          const int alpha = made ? made->rgba[static_cast<std::size_t>(k) * 4 + 3] : 0;
          if (to_middle < -1e-6) {
            ASSERT_EQ(alpha, 0) << lat << "," << lon;
            ++clear;
          }
          if (to_middle > 0.3) {
            ASSERT_EQ(alpha, 255) << level << ": " << lat << "," << lon;
            ++drawn;
          }
        }
      }
    }
  }
  EXPECT_GT(drawn, 1000);
  EXPECT_GT(clear, 1000);
}

TEST(Warp, OnePixelIsDrawn) {
  const auto tiles = warped(std::make_unique<PaintedRaster>(degrees(20.0, 11.0, 1.0, 1, 1), plain, plain));
  const TileGrid& grid = tiles->info().grid;
  const TileId id = tile_over(grid, grid.max_level, 10.5, 20.5);
  const auto made = drawn_tile(*tiles, id);
  ASSERT_TRUE(made) << made.error().why;
  int opaque = 0;
  for (std::size_t k = 0; k < made->rgba.size(); k += 4) opaque += made->rgba[k + 3] == 255 ? 1 : 0;
  EXPECT_EQ(opaque, 1);
}

TEST(Warp, WithoutOverviewsCoarseTilesShowTheMean) {
  PaintedOptions options = degrees(-180.0, 90.0, 0.25, 1440, 720);
  options.crs = "+proj=eqc +R=6378137";
  options.to_crs = {-180 * kDeg_m, 0.25 * kDeg_m, 0.0, 90 * kDeg_m, 0.0, -0.25 * kDeg_m};
  // Stripes of one pixel: only their mean is right in a tile of eight degrees a pixel.
  const auto stripes = [](double, double lon) {
    return std::fmod(std::floor(lon * 4.0) + 1e6, 2.0) < 1.0 ? 0.0 : 200.0;
  };
  auto raster = std::make_unique<PaintedRaster>(options, stripes, by_latitude);
  PaintedRaster& stored = *raster;
  const auto tiles = warped(std::move(raster));
  const auto made = drawn_tile(*tiles, {0, 0, 0});
  ASSERT_TRUE(made);
  const double step = tile_span_deg(tiles->info().grid, 0) / 64;
  for (int y = 1; y + 1 < 64 && 90.0 - (y + 1) * step > -90.0; ++y) {
    for (int x = 1; x + 1 < 64; ++x) {
      const std::uint8_t* at = &made->rgba[static_cast<std::size_t>(y * 64 + x) * 4];
      ASSERT_NEAR(at[0], 100.0, 4.0) << x << "," << y;
      ASSERT_NEAR(at[1], 127.5 + 90.0 - (y + 0.5) * step, 1.5);
    }
  }
  for (const auto& [block, times] : stored.reads()) EXPECT_EQ(times, 1) << block.x << "," << block.y;
}

TEST(Warp, BetweenOverviewsThatAreFarApartTilesKeepTheirDetail) {
  PaintedOptions options = degrees(-180.0, 90.0, 0.25, 1440, 720);
  options.crs = "+proj=eqc +R=6378137";
  options.to_crs = {-180 * kDeg_m, 0.25 * kDeg_m, 0.0, 90 * kDeg_m, 0.0, -0.25 * kDeg_m};
  options.overviews = 4;
  // Waves of 32 columns: four pixels of the tile. The overview's pixels of 16 columns are all means of half a wave.
  const auto wave = [](double, double lon) { return 100.0 + 100.0 * std::cos((lon + 180.0) * M_PI / 4.0); };
  auto raster = std::make_unique<PaintedRaster>(options, wave, by_latitude);
  auto& levels = raster->change().levels;
  levels.erase(levels.begin() + 1, levels.end() - 1);
  const auto tiles = warped(std::move(raster));
  const double step = tile_span_deg(tiles->info().grid, 1) / 64;
  ASSERT_NEAR(step, 2.0, 1e-9);
  const auto made = drawn_tile(*tiles, {1, 0, 0});
  ASSERT_TRUE(made);
  double squares = 0.0;
  for (int x = 1; x + 1 < 64; ++x) {
    const double miss = made->rgba[static_cast<std::size_t>(20 * 64 + x) * 4] - wave(0.0, -180.0 + (x + 0.5) * step);
    squares += miss * miss / 62.0;
  }
  // A mean over a quarter of a wave takes a tenth of its height, the filter as much again. Without waves it is 71.
  EXPECT_LT(std::sqrt(squares), 25.0);
}

TEST(Warp, NumbersWithoutDataTakeNoPart) {
  PaintedOptions options{.crs = "+proj=sinu +R=6378137",
                         .to_crs = {-2e6, 2e4, 0.0, 2e6, 0.0, -2e4},
                         .width_px = 200,
                         .height_px = 200,
                         .numbers = true,
                         .rays = 1};
  // An island: unknown round it. Its numbers are far from 0, so that a mixture shows.
  const auto island = [](double lat, double lon) {
    return std::hypot(lat, lon) < 10.0 ? 200.0 : std::numeric_limits<double>::quiet_NaN();
  };
  class Island : public PaintedRaster {
   public:
    using PaintedRaster::PaintedRaster;
    [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
      auto tile = PaintedRaster::read(id);
      tile->make_numbers = [make = tile->make_numbers]() {
        auto numbers = make();
        for (float& value : numbers->values) value = value < 100.0F ? std::numeric_limits<float>::quiet_NaN() : value;
        return numbers;
      };
      return tile;
    }
  };
  const auto tiles = warped(std::make_unique<Island>(
      options, [&](double lat, double lon) { return std::isnan(island(lat, lon)) ? 0.0 : 200.0; }, plain));
  ASSERT_TRUE(tiles->info().numbers);
  EXPECT_TRUE(tiles->info().numbers->floats);
  const TileGrid& grid = tiles->info().grid;
  int known = 0, unknown = 0;
  for (const double lat : {8.0, -8.0}) {
    const auto tile = tiles->read(tile_over(grid, grid.max_level, lat, 3.0));
    ASSERT_TRUE(tile) << tile.error().why;
    const auto numbers = tile->make_numbers();
    ASSERT_TRUE(numbers);
    for (const float value : numbers->values) {
      if (std::isnan(value)) {
        ++unknown;
      } else {
        ASSERT_NEAR(value, 200.0F, 0.01F);
        ++known;
      }
    }
    EXPECT_TRUE(decode_heights({}, *tile, *tiles->info().numbers, 64));
  }
  EXPECT_GT(known, 500);
  EXPECT_GT(unknown, 500);
}

TEST(Warp, FaultsOfBlocksAreThoseOfTiles) {
  const PaintedOptions options = degrees(-180.0, 90.0, 0.5, 720, 360);
  for (const MissingKind kind : {MissingKind::failed, MissingKind::broken, MissingKind::absent, MissingKind::blank}) {
    auto raster = std::make_unique<PaintedRaster>(options, plain, plain);
    for (int x = 0; x < 12; ++x) {
      for (int y = 0; y < 6; ++y) raster->note_missing({0, x, y}, kind);
    }
    const auto tiles = warped(std::move(raster));
    const TileGrid& grid = tiles->info().grid;
    const auto made = tiles->read(tile_over(grid, grid.max_level, 10.0, 10.0));
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().kind, kind);
    EXPECT_NE(made.error().why.find("the test says so"), std::string::npos);
  }
}

}  // namespace
}  // namespace terrella
