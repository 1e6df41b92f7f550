#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "geo/body.h"
#include "streaming/preload/geojson_region.h"
#include "streaming/preload/tile_plan.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto region = terrella::parse_geojson_region({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!region) return 0;
  constexpr int kLevel = 4;
  terrella::TileGrid grid;
  grid.max_level = kLevel;
  const auto plan = terrella::plan_region(grid, terrella::earth().ellipsoid, *std::move(region), kLevel, kLevel);
  std::int64_t walked = 0;
  const auto feed = plan->walk();
  while (const auto run = feed->next()) walked += run->count();
  if (walked != plan->total() || walked > (2LL << (2 * kLevel))) std::abort();
  return 0;
}
