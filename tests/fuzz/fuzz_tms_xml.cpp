#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "streaming/sets/tms_xml.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto tms = terrella::parse_tms_xml({reinterpret_cast<const char*>(data), size}, "fuzz");
  if (!tms) return 0;
  const terrella::TileGrid& grid = tms->info.grid;
  for (int level = grid.min_level; level <= grid.max_level; ++level) {
    if (!tms->folder.contains(level) || terrella::columns(grid, level) < 1) std::abort();
  }
  return 0;
}
