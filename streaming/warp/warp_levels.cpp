#include "streaming/warp/warp_levels.h"

#include <algorithm>
#include <cmath>

namespace terrella {
namespace {

std::int64_t over(std::int64_t count, std::int64_t size) { return (count + size - 1) / size; }

Affine reduced_by(Affine from_finest, double square) {
  for (double* part : {&from_finest.x0, &from_finest.x_per_column, &from_finest.x_per_row, &from_finest.y0,
                       &from_finest.y_per_column, &from_finest.y_per_row}) {
    *part /= square;
  }
  return from_finest;
}

WarpLevel level_of(const RasterInfo& raster, int stored, int halvings, const std::optional<CrsPoint>& turn_px) {
  const RasterLevel& from = raster.levels[static_cast<std::size_t>(stored)];
  const double square = std::ldexp(1.0, halvings);
  WarpLevel level{.stored = stored, .halvings = halvings, .area = {}, .from_finest = {}};
  level.from_finest = reduced_by(level_from_finest(from, raster.levels.back()), square);
  const Affine& to = level.from_finest;
  level.pixel_size = 1.0 / std::sqrt(std::abs(to.x_per_column * to.y_per_row - to.x_per_row * to.y_per_column));
  level.area = {.width_px = static_cast<double>(from.width_px) / square,
                .height_px = static_cast<double>(from.height_px) / square};
  if (turn_px) {
    level.area.turn_px = CrsPoint{to.x_per_column * turn_px->x + to.x_per_row * turn_px->y,
                                  to.y_per_column * turn_px->x + to.y_per_row * turn_px->y};
  }
  level.block_width_px = (from.block_width_px + (1 << halvings) - 1) >> halvings;
  level.block_height_px = (from.block_height_px + (1 << halvings) - 1) >> halvings;
  level.blocks_across = over(from.width_px, from.block_width_px);
  level.blocks_down = over(from.height_px, from.block_height_px);
  return level;
}

bool is_half(const WarpLevel& coarse, const WarpLevel& fine) {
  const auto near = [](double a, double b) { return std::abs(a - b) < 1e-6; };
  return coarse.halvings == 0 && fine.halvings == 0 && coarse.block_width_px == fine.block_width_px &&
         coarse.block_height_px == fine.block_height_px && near(coarse.pixel_size / fine.pixel_size, 2.0) &&
         near(coarse.from_finest.x0 * 2.0, fine.from_finest.x0) &&
         near(coarse.from_finest.y0 * 2.0, fine.from_finest.y0) &&
         coarse.blocks_across == over(fine.blocks_across, 2) && coarse.blocks_down == over(fine.blocks_down, 2);
}

/// True if blocks side by side stay side by side when their squares become pixels.
bool divides(const RasterLevel& level, int halvings) {
  const int square = 1 << halvings;
  return (level.block_width_px % square == 0 || level.block_width_px >= level.width_px) &&
         (level.block_height_px % square == 0 || level.block_height_px >= level.height_px);
}

/// Adds reduced levels of a stored level: those that are coarser than it and finer than `coarsest_px`, in its pixels.
void add_reduced(const RasterInfo& raster, int stored, const std::optional<CrsPoint>& turn_px, double coarsest_px,
                 std::vector<WarpLevel>& levels) {
  const RasterLevel& from = raster.levels[static_cast<std::size_t>(stored)];
  int halvings = 0;
  while (halvings < 29 && divides(from, halvings + 1) && std::ldexp(1.0, halvings + 1) < coarsest_px) ++halvings;
  for (; halvings > 0; --halvings) levels.push_back(level_of(raster, stored, halvings, turn_px));
}

}  // namespace

std::int64_t WarpLevel::columns() const {
  return area.is_cyclic() ? std::llround(std::abs(area.turn_px->x))
                          : static_cast<std::int64_t>(std::ceil(area.width_px));
}
std::int64_t WarpLevel::rows() const { return static_cast<std::int64_t>(std::ceil(area.height_px)); }

std::vector<WarpLevel> warp_levels(const RasterInfo& raster, const std::optional<CrsPoint>& turn_px, int tile_px,
                                   Overviews overviews) {
  // An overview of a side that does not divide evenly is a little less than half.
  constexpr double kLeastStep = 2.0 * 1.1;
  std::vector<WarpLevel> levels;
  const RasterLevel& coarsest = raster.levels.front();
  const double side = static_cast<double>(std::max(coarsest.width_px, coarsest.height_px));
  const bool made = overviews == Overviews::made;
  if (made) add_reduced(raster, 0, turn_px, side / tile_px, levels);
  for (int stored = 0; stored < static_cast<int>(raster.levels.size()); ++stored) {
    WarpLevel level = level_of(raster, stored, 0, turn_px);
    const bool gap = made && stored > 0 && levels.back().pixel_size > kLeastStep * level.pixel_size;
    if (gap) add_reduced(raster, stored, turn_px, levels.back().pixel_size / level.pixel_size / 1.5, levels);
    level.has_parents = !levels.empty() && is_half(levels.back(), level);
    levels.push_back(level);
  }
  return levels;
}

void for_each_part(const WarpLevel& level, int index, const PixelRect64& rect,
                   const std::function<void(const BlockPart&)>& call) {
  const std::int64_t columns = level.columns();
  const bool cyclic = level.area.is_cyclic();
  const std::int64_t top = std::max<std::int64_t>(rect.v0, 0), bottom = std::min(rect.v1, level.rows());
  std::int64_t u = cyclic ? rect.u0 : std::max<std::int64_t>(rect.u0, 0);
  const std::int64_t end = cyclic ? rect.u1 : std::min(rect.u1, columns);
  while (u < end) {
    const std::int64_t column = ((u % columns) + columns) % columns;
    const std::int64_t x = column / level.block_width_px, in_x = column % level.block_width_px;
    const std::int64_t width = std::min({level.block_width_px - in_x, columns - column, end - u});
    for (std::int64_t v = top; v < bottom;) {
      const std::int64_t y = v / level.block_height_px, in_y = v % level.block_height_px;
      const std::int64_t height = std::min(level.block_height_px - in_y, bottom - v);
      call({.block = {.level = index, .x = x, .y = y},
            .x = static_cast<int>(in_x),
            .y = static_cast<int>(in_y),
            .to_x = u - rect.u0,
            .to_y = v - rect.v0,
            .width = static_cast<int>(width),
            .height = static_cast<int>(height)});
      v += height;
    }
    u += width;
  }
}

}  // namespace terrella
