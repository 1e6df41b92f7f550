#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "streaming/remote/wmts/wmts.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto set = terrella::parse_wmts_capabilities({reinterpret_cast<const char*>(data), size}, {}, "fuzz");
  if (!set) return 0;
  const terrella::TileGrid& grid = set->info.grid;
  for (int level = grid.min_level; level <= grid.max_level; ++level) {
    const terrella::TileId last{level, terrella::columns(grid, level) - 1, terrella::rows(grid, level) - 1};
    if (terrella::tile_url(*set, last).empty()) std::abort();
  }
  static_cast<void>(terrella::source_key(*set));
  return 0;
}
