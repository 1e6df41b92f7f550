// Cost of a tile made of a raster, beside the cost of decoding the blocks that it is made of.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

#include "geo/body.h"
#include "streaming/warp/filter/resample.h"
#include "streaming/warp/make_warp_source.h"

namespace terrella {
namespace {

constexpr int kTilePx = 256;
constexpr double kDegree_m = 6378137.0 * 3.14159265358979323846 / 180.0;

/// As rough as a picture from above: JPEG at quality 85 takes about 20 kB for it.
std::shared_ptr<const Block> rough_block() {
  static const auto block = [] {
    Image tile{kTilePx, kTilePx, {}};
    unsigned noise = 1;
    for (int i = 0; i < kTilePx * kTilePx; ++i) {
      noise = noise * 1664525U + 1013904223U;
      const double wave = std::sin(i % kTilePx * 0.11) + std::cos(i / kTilePx * 0.17);
      const auto level = static_cast<std::uint8_t>(120.0 + 40.0 * wave + (noise >> 28U));
      tile.rgba.insert(tile.rgba.end(), {level, static_cast<std::uint8_t>(level / 2), 90, 255});
    }
    return std::make_shared<const Block>(std::move(tile));
  }();
  return block;
}

/// A raster of a whole planet in a projection, with overviews down to a tile.
RasterInfo raster_in(const char* crs, double half_width_m, double half_height_m, int levels) {
  RasterInfo raster{.name = {}, .attribution = {}, .crs = crs, .levels = {}};
  for (int level = 0; level <= levels; ++level) {
    const double pixel_m = 2.0 * half_width_m / std::ldexp(kTilePx, level);
    raster.levels.push_back({.width_px = std::int64_t{kTilePx} << level,
                             .height_px = std::llround(2.0 * half_height_m / pixel_m),
                             .block_width_px = kTilePx,
                             .block_height_px = kTilePx,
                             .to_crs = {-half_width_m, pixel_m, 0.0, half_height_m, 0.0, -pixel_m}});
  }
  return raster;
}

struct Subject {
  RasterInfo raster;
  TileGrid grid;
};

/// 0: Web Mercator on its grid. 1: sinusoidal. 2: polar stereographic. 3: plate carrée off the grid. 4: on the grid.
Subject subject(std::int64_t which) {
  const WarpOptions options{.figure = {.ellipsoid = earth().ellipsoid}, .body = {}};
  const auto with_grid = [&](RasterInfo raster) { return Subject{raster, *warp_grid(raster, options, "raster")}; };
  constexpr double kTurn_m = 180.0 * kDegree_m;
  if (which == 1) return with_grid(raster_in("+proj=sinu +R=6378137 +type=crs", kTurn_m, 0.5 * kTurn_m, 10));
  if (which == 2) return with_grid(raster_in("EPSG:3995", 4e6, 4e6, 8));
  if (which == 3) return with_grid(raster_in("+proj=eqc +R=6378137 +type=crs", 0.9 * kTurn_m, 0.45 * kTurn_m, 10));
  if (which == 4) return with_grid(raster_in("+proj=eqc +lon_0=180 +R=6378137 +type=crs", kTurn_m, 0.5 * kTurn_m, 10));
  const TileGrid grid{.root_span_deg = 360.0, .tile_px = kTilePx, .max_level = 15};
  return {raster_in("EPSG:3857", kTurn_m, kTurn_m, 12), grid};
}

TileId tile_at(const TileGrid& grid, int level, double lat_deg, double lon_deg) {
  const TileXY at = tile_xy(grid, level, lat_deg, lon_deg);
  return {level, static_cast<std::int64_t>(at.x), static_cast<std::int64_t>(at.y)};
}

TileId tile_of(const Subject& subject, std::int64_t which, double lat_deg) {
  return tile_at(subject.grid, which == 0 ? 10 : subject.grid.max_level, lat_deg, 30.0);
}

void plan(benchmark::State& state) {
  const Subject from = subject(state.range(0));
  const auto planner = *TilePlanner::open(from.raster, {.ellipsoid = earth().ellipsoid}, from.grid, Overviews::stored);
  const TileId id = tile_of(from, state.range(0), static_cast<double>(state.range(1)));
  for (auto _ : state) benchmark::DoNotOptimize(planner->plan(id));
}

void make_tile(benchmark::State& state) {
  const Subject from = subject(state.range(0));
  const auto planner = *TilePlanner::open(from.raster, {.ellipsoid = earth().ellipsoid}, from.grid, Overviews::stored);
  const WarpPlan planned = *planner->plan(tile_of(from, state.range(0), static_cast<double>(state.range(1))));
  const WarpLevel& level = planner->frame().levels[static_cast<std::size_t>(planned.level)];
  const auto block_at = [](const TileId&) -> Result<std::shared_ptr<const Block>, TileFailure> {
    return rough_block();
  };
  for (auto _ : state) benchmark::DoNotOptimize(warp_picture(planned, level, block_at));
  state.counters["pieces"] = static_cast<double>(planned.pieces.size());
}

void arguments(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"raster", "lat"});
  for (const int lat : {0, 47, 70, 83}) bench->Args({0, lat});
  bench->Args({1, 0})->Args({1, 47})->Args({1, 80})->Args({2, 70})->Args({2, 89})->Args({3, 47})->Args({4, 47});
}
BENCHMARK(plan)->Apply(arguments);
BENCHMARK(make_tile)->Apply(arguments);

void decode_one(benchmark::State& state) {
  const Image& image = std::get<Image>(*rough_block());
  const auto bytes = state.range(0) == 0 ? *encode_jpeg(image, 85) : *encode_png(image);
  for (auto _ : state) benchmark::DoNotOptimize(decode_image(bytes));
}
BENCHMARK(decode_one)->ArgName("png")->Arg(0)->Arg(1);

}  // namespace
}  // namespace terrella

BENCHMARK_MAIN();
