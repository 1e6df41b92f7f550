#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "streaming/raster/open_raster.h"
#include "tests/fuzz/memory_file.h"

namespace {

/// Reads the first and the last block of a level. A header can claim a picture of terabytes: enough is read to pass
/// every stage.
void read_some(terrella::RasterSource& source, std::size_t index) {
  const terrella::RasterLevel& level = source.info().levels[index];
  if (level.width_px < 1 || level.height_px < 1 || level.block_width_px < 1 || level.block_height_px < 1) std::abort();
  const bool is_small = level.width_px * level.height_px < 1 << 20;
  const terrella::TileId first{.level = static_cast<int>(index)};
  const terrella::TileId last{.level = static_cast<int>(index),
                              .x = (level.width_px - 1) / level.block_width_px,
                              .y = (level.height_px - 1) / level.block_height_px};
  for (const terrella::TileId& id : {first, is_small ? last : first}) {
    auto tile = source.read(id);
    if (!tile) std::abort();
    const bool failed = tile->make_numbers ? !tile->make_numbers() : !tile->make_picture();
    if (failed) return;
  }
}

}  // namespace

/// Whatever the directories and tiles are, a TIFF gives blocks or an error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const terrella::test::MemoryFile file(data, size);
  for (const bool heights : {false, true}) {
    terrella::RasterOptions options;
    options.heights = heights;
    options.jobs = 1;
    const auto source = terrella::open_raster(file.path(), {}, options);
    if (!source && source.error().message.empty()) std::abort();
    for (std::size_t i = 0; source && i < (*source)->info().levels.size(); ++i) read_some(**source, i);
  }
  return 0;
}
