#include "streaming/warp/filter/resample.h"

#include "streaming/warp/filter/resample_lines.h"
#include "streaming/warp/filter/resample_patch.h"
#include "streaming/warp/tile_pixels.h"

namespace terrella {
namespace {

/// The pole cuts off a part of the last row, but is no edge of the picture.
void end_at_pole(const WarpPlan& plan, Image& picture) {
  const auto width = static_cast<std::size_t>(plan.tile_px) * 4;
  std::uint8_t* const last = picture.rgba.data() + static_cast<std::size_t>(plan.rows - 1) * width;
  for (std::size_t alpha = 3; alpha < width && plan.rows > 1; alpha += 4) {
    if (last[alpha] > 0 && *(last + alpha - width) == 255) last[alpha] = 255;
  }
}
void end_at_pole(const WarpPlan&, Numbers&) {}

/// Opaque down to the tile's end, a tile at the south pole needs no other layer under it, and filters do not mix in
/// nothing.
template <class Tile>
void fill_beyond_pole(const WarpPlan& plan, typename Tile::Pixels& pixels) {
  if (plan.rows < 1 || plan.rows >= plan.tile_px) return;
  end_at_pole(plan, pixels);
  const BlockPart last{.block = {}, .x = 0, .y = plan.rows - 1, .width = plan.tile_px, .height = 1};
  for (int row = plan.rows; row < plan.tile_px; ++row) {
    Tile::copy(pixels, last, pixels, static_cast<std::size_t>(row) * static_cast<std::size_t>(plan.tile_px));
  }
}

template <class Tile>
Result<typename Tile::Pixels, TileFailure> warped(const WarpPlan& plan, const WarpLevel& level,
                                                  const BlockAt& block_at) {
  auto pixels = Tile::make(plan.tile_px);
  if (plan.lines && are_copies(*plan.lines)) {
    if (auto failed = copy_lines<Tile>(plan, level, block_at, pixels)) return *failed;
    fill_beyond_pole<Tile>(plan, pixels);
    return pixels;
  }
  if (plan.lines) {
    const auto canvas = read_canvas<Tile::kChannels>(level, plan.level, plan.lines->canvas, block_at);
    if (!canvas) return canvas.error();
    resample_lines<Tile>(plan.lines->columns, plan.lines->rows, *canvas, pixels);
  }
  for (const WarpChunk& chunk : plan.chunks) {
    const auto canvas = read_canvas<Tile::kChannels>(level, plan.level, chunk.canvas, block_at);
    if (!canvas) return canvas.error();
    for (const Patch& patch : chunk.patches) resample_patch<Tile>(patch, level.area, *canvas, pixels);
  }
  fill_beyond_pole<Tile>(plan, pixels);
  return pixels;
}

}  // namespace

Result<Image, TileFailure> warp_picture(const WarpPlan& plan, const WarpLevel& level, const BlockAt& block_at) {
  return warped<ColourTile>(plan, level, block_at);
}

Result<Numbers, TileFailure> warp_numbers(const WarpPlan& plan, const WarpLevel& level, const BlockAt& block_at) {
  return warped<NumberTile>(plan, level, block_at);
}

}  // namespace terrella
