#include "streaming/tile_range.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace terrella {
namespace {

/// Columns or rows [first, last].
struct Span {
  std::int64_t first, last;
};

/// The tiles that reach over [low, high], counted in tiles, with one more on each side: exists() has the last word.
Span candidates(double low, double high, std::int64_t count) {
  return {std::max<std::int64_t>(0, static_cast<std::int64_t>(std::floor(low)) - 1),
          std::min(count - 1, static_cast<std::int64_t>(std::ceil(high)) + 1)};
}

std::vector<Span> column_spans(const TileGrid& grid, int level) {
  const std::int64_t count = columns(grid, level);
  const double west = tile_xy(grid, level, 0.0, grid.bounds.west.deg()).x;
  const double east = tile_xy(grid, level, 0.0, grid.bounds.east.deg()).x;
  if (grid.bounds.west < grid.bounds.east) return {candidates(west, east, count)};
  const Span before = candidates(0.0, east, count);
  const Span after = candidates(west, static_cast<double>(count), count);
  if (after.first <= before.last) return {{before.first, after.last}};
  return {before, after};
}

Span row_span(const TileGrid& grid, int level) {
  return candidates(tile_xy(grid, level, grid.bounds.north.deg(), 0.0).y,
                    tile_xy(grid, level, grid.bounds.south.deg(), 0.0).y, rows(grid, level));
}

/// Narrows a span to the tiles for which `is_there` holds; they are neighbours of one another, and its ends are near
/// theirs.
template <class IsThere>
Span narrowed(Span span, const IsThere& is_there) {
  while (span.first <= span.last && !is_there(span.first)) ++span.first;
  while (span.last >= span.first && !is_there(span.last)) --span.last;
  return span;
}

/// True if the row exists; the first column that does is among the first few candidates.
bool touches_row(const TileGrid& grid, int level, const Span& columns, std::int64_t y) {
  for (std::int64_t x = columns.first; x <= std::min(columns.first + 3, columns.last); ++x) {
    if (exists(grid, {level, x, y})) return true;
  }
  return false;
}

}  // namespace

void for_each_place(const TileGrid& grid, int level, const std::function<bool(const TileId&)>& call) {
  const Span rows = row_span(grid, level);
  const std::vector<Span> spans = column_spans(grid, level);
  for (std::int64_t y = rows.first; y <= rows.last; ++y) {
    for (const Span& span : spans) {
      for (std::int64_t x = span.first; x <= span.last; ++x) {
        const TileId id{level, x, y};
        if (exists(grid, id) && !call(id)) return;
      }
    }
  }
}

std::int64_t count_places(const TileGrid& grid, int level) {
  const Span all_rows = row_span(grid, level);
  std::int64_t count = 0;
  for (const Span& all_columns : column_spans(grid, level)) {
    // Rows and columns are independent of one another: a tile exists if its row and its column touch the bounds.
    const Span rows = narrowed(all_rows, [&](std::int64_t y) { return touches_row(grid, level, all_columns, y); });
    if (rows.first > rows.last) continue;
    const Span columns = narrowed(all_columns, [&](std::int64_t x) { return exists(grid, {level, x, rows.first}); });
    count += (rows.last - rows.first + 1) * std::max<std::int64_t>(0, columns.last - columns.first + 1);
  }
  return count;
}

}  // namespace terrella
