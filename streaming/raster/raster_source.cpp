#include "streaming/raster/raster_source.h"

#include <cmath>

#include "tiles/height_decoder.h"

namespace terrella {

Result<double, TileFailure> RasterSource::value_at(std::int64_t column, std::int64_t row) {
  const RasterInfo& raster = info();
  const RasterLevel& finest = raster.levels.back();
  const bool inside = column >= 0 && row >= 0 && column < finest.width_px && row < finest.height_px;
  if (!raster.numbers || !inside) return TileFailure{MissingKind::absent, "outside the raster"};
  const auto block = read({.level = static_cast<int>(raster.levels.size()) - 1,
                           .x = column / finest.block_width_px,
                           .y = row / finest.block_height_px});
  if (!block) return block.error();
  const auto numbers =
      block->make_numbers ? block->make_numbers() : decode_numbers(*block, *raster.numbers, finest.block_width_px);
  if (!numbers) return numbers.error();
  const auto x = column % finest.block_width_px, y = row % finest.block_height_px;
  if (x >= numbers->width_px || y >= numbers->height_px) return TileFailure{MissingKind::broken, "the block is small"};
  const double number = numbers->values[static_cast<std::size_t>(y * numbers->width_px + x)];
  if (std::isnan(number)) return TileFailure{MissingKind::blank, "no data"};
  return (number * block->number_scale + block->number_offset) * raster.numbers->scale + raster.numbers->offset;
}

}  // namespace terrella
