#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "streaming/remote/gdal_wms/gdal_wms.h"
#include "streaming/remote/wms/wms.h"

namespace {

/// Asks for the last tile of each level.
void use(const terrella::RemoteTileSet& set) {
  const terrella::TileGrid& grid = set.info.grid;
  for (int level = grid.min_level; level <= grid.max_level; ++level) {
    const terrella::TileId last{level, terrella::columns(grid, level) - 1, terrella::rows(grid, level) - 1};
    if (terrella::tile_url(set, last).empty()) std::abort();
  }
  static_cast<void>(terrella::source_key(set));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto set = terrella::parse_gdal_wms(text, {}, "fuzz")) use(*set);
  const auto address = terrella::read_wms_address("http://a/wms?service=WMS&layers=l");
  if (const auto set = terrella::parse_wms_capabilities(text, address, {}, "fuzz")) use(*set);
  return 0;
}
