#include "streaming/sets/tms_roots.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

namespace terrella {
namespace {

namespace fs = std::filesystem;

struct Range {
  std::int64_t first, last;
  bool operator==(const Range&) const = default;
  [[nodiscard]] bool within(const Range& other) const { return first >= other.first && last <= other.last; }
};

void widen(std::optional<Range>& range, std::int64_t value) {
  range = range ? Range{std::min(range->first, value), std::max(range->last, value)} : Range{value, value};
}

/// Smallest and largest number among the names in a folder, without endings.
std::optional<Range> numbers_in(const fs::path& folder) {
  std::optional<Range> range;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().stem().string();
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc{} && end == name.data() + name.size()) widen(range, number);
  }
  return range;
}

/// Tiles of a span that cover [low, high] degrees, counted from `origin`.
Range tiles_over(double low_deg, double high_deg, double origin_deg, double span_deg) {
  constexpr double kSliver = 1e-6;  // fraction of a tile
  return {static_cast<std::int64_t>(std::floor((low_deg - origin_deg) / span_deg + kSliver)),
          static_cast<std::int64_t>(std::ceil((high_deg - origin_deg) / span_deg - kSliver)) - 1};
}

}  // namespace

Result<TmsDescription> correct_tms_roots(TmsDescription tms, const fs::path& root) {
  const TileGrid& grid = tms.info.grid;
  if (grid.projection == Projection::web_mercator) return tms;
  const fs::path finest = root / tms.folder.at(grid.max_level);
  const std::optional<Range> columns = numbers_in(finest);
  if (!columns) return tms;
  const std::optional<Range> rows = numbers_in(finest / std::to_string(columns->last));
  if (!rows) return tms;
  const auto fits = [&](double span_deg) {
    return *columns == tiles_over(grid.bounds.west.deg(), grid.bounds.east.deg(), -180.0, span_deg) &&
           rows->within(tiles_over(grid.bounds.south.deg(), grid.bounds.north.deg(), -90.0, span_deg));
  };
  const double span_deg = tile_span_deg(grid, grid.max_level);
  if (fits(span_deg) || !fits(2.0 * span_deg)) return tms;
  tms.info.grid.root_span_deg *= 2.0;
  if (180.0 / tile_span_deg(tms.info.grid, grid.min_level) < 0.75) {
    if (grid.min_level == grid.max_level) {
      return Error{
          root.string() +
          ": its only level has one tile that reaches from -90° to 270°; make more levels (gdal2tiles.py -z 1-…)"};
    }
    tms.folder.erase(grid.min_level);
    ++tms.info.grid.min_level;
  }
  return tms;
}

}  // namespace terrella
