// What a tile made of Web Mercator's costs beside the decoding of what it is made of.
#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

#include "streaming/mercator/mercator_grid.h"
#include "streaming/mercator/resample.h"

namespace terrella {
namespace {

constexpr int kTilePx = 256;
constexpr TileGrid kSquare{
    .root_span_deg = 360.0, .tile_px = kTilePx, .max_level = 12, .projection = Projection::web_mercator};

/// As rough as a picture from above: JPEG at quality 85 takes about 20 kB for it.
std::shared_ptr<const Image> rough_tile() {
  Image tile{kTilePx, kTilePx, {}};
  unsigned noise = 1;
  for (int i = 0; i < kTilePx * kTilePx; ++i) {
    noise = noise * 1664525U + 1013904223U;
    const double wave = std::sin(i % kTilePx * 0.11) + std::cos(i / kTilePx * 0.17);
    const auto level = static_cast<std::uint8_t>(120.0 + 40.0 * wave + (noise >> 28U));
    tile.rgba.insert(tile.rgba.end(), {level, static_cast<std::uint8_t>(level / 2), 90, 255});
  }
  return std::make_shared<const Image>(std::move(tile));
}

TileId tile_at(int level, double lat_deg) {
  return {level, 10, static_cast<std::int64_t>(tile_xy(geodetic_grid_of(kSquare), level, lat_deg, 0.0).y)};
}

void plan(benchmark::State& state) {
  const TileId id = tile_at(10, static_cast<double>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(plan_tile(kSquare, id));
}
BENCHMARK(plan)->Arg(0)->Arg(47)->Arg(70);

void make_tile(benchmark::State& state) {
  const MercatorPlan planned = plan_tile(kSquare, tile_at(10, static_cast<double>(state.range(0))));
  const std::vector<PiecePicture> pictures(planned.pieces.size(), PiecePicture{.picture = rough_tile()});
  for (auto _ : state) benchmark::DoNotOptimize(resample(planned, pictures));
  state.counters["pieces"] = static_cast<double>(planned.pieces.size());
}
BENCHMARK(make_tile)->Arg(0)->Arg(47)->Arg(70)->Arg(83);

void decode_one(benchmark::State& state) {
  const auto bytes = state.range(0) == 0 ? *encode_jpeg(*rough_tile(), 85) : *encode_png(*rough_tile());
  for (auto _ : state) benchmark::DoNotOptimize(decode_image(bytes));
}
BENCHMARK(decode_one)->ArgName("png")->Arg(0)->Arg(1);

}  // namespace
}  // namespace terrella

BENCHMARK_MAIN();
