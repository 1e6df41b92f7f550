#include "streaming/numbers/sample_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <limits>
#include <memory>
#include <vector>

#include "tiles/height_decoder.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

constexpr double kEnoughPixels = 131072.0;
constexpr std::size_t kMostTiles = 64;
constexpr std::chrono::seconds kPatience(20);
using Time = std::chrono::steady_clock::time_point;

int sampled_level(const TileGrid& grid) {
  const GeoRect& b = grid.bounds;
  const double width_deg = b.east.deg() - b.west.deg() + (b.east <= b.west ? 360.0 : 0.0);
  const double height_deg = row_bounds(grid).north_deg - row_bounds(grid).south_deg;
  for (int level = grid.min_level; level < grid.max_level; ++level) {
    const double per_degree = grid.tile_px / tile_span_deg(grid, level);
    if (width_deg * height_deg * per_degree * per_degree >= kEnoughPixels) return level;
  }
  return grid.max_level;
}

}  // namespace

/// All tiles of the level, or an even choice of them.
std::vector<TileId> sampled_places(const TileGrid& grid) {
  const int level = sampled_level(grid);
  const std::int64_t count = count_places(grid, level);
  const auto step = std::max<std::int64_t>(
      1, (count + static_cast<std::int64_t>(kMostTiles) - 1) / static_cast<std::int64_t>(kMostTiles));
  std::vector<TileId> places;
  std::int64_t at = 0;
  for_each_place(grid, level, [&](const TileId& id) {
    if (at++ % step == step / 2) places.push_back(id);
    return places.size() < kMostTiles;
  });
  return places;
}

namespace {

Result<EncodedTile, TileFailure> read_anywhere(TileSource& tiles, const TileId& id, Time deadline) {
  auto tile = tiles.read(id);
  if (tile || tile.error().kind != MissingKind::remote || tiles.remote() == nullptr) return tile;
  using Answer = Result<EncodedTile, TileFailure>;
  const auto promise = std::make_shared<std::promise<Answer>>();
  std::future<Answer> answer = promise->get_future();
  tiles.remote()->fetch(id, 0.0, [promise](Answer come) { promise->set_value(std::move(come)); });
  if (answer.wait_until(deadline) == std::future_status::ready) return answer.get();
  tiles.remote()->cancel(id);
  return TileFailure{MissingKind::failed, "no answer in time"};
}

/// Adds the numbers of a tile that lie inside the bounds.
void add_inside(const TileGrid& grid, const TileId& id, const EncodedTile& tile, const Numbers& numbers,
                std::vector<float>& all) {
  const TileBounds tile_at = tile_bounds(grid, id);
  const double pixel_deg = tile_span_deg(grid, id.level) / grid.tile_px;
  const RowLatitudes rows = row_bounds(grid);
  const double west = grid.bounds.west.deg(), east = grid.bounds.east.deg();
  const auto has_column = [&](double lon) { return west < east ? lon > west && lon < east : lon > west || lon < east; };
  for (int y = 0; y < numbers.height_px; ++y) {
    const double lat = tile_at.north_deg - (y + 0.5) * pixel_deg;
    if (lat < rows.south_deg || lat > rows.north_deg) continue;
    const float* row = numbers.values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(numbers.width_px);
    for (int x = 0; x < numbers.width_px; ++x) {
      const double lon = tile_at.west_deg + (x + 0.5) * pixel_deg;
      if (lon < 180.0 && has_column(lon)) {
        all.push_back(static_cast<float>(static_cast<double>(row[x]) * tile.number_scale + tile.number_offset));
      }
    }
  }
}

}  // namespace

Result<NumberStatistics> sample_tiles(TileSource& tiles) {
  const TileSetInfo& info = tiles.info();
  const NumberInfo& numbers = *info.numbers;
  const Time deadline = std::chrono::steady_clock::now() + kPatience;
  std::vector<float> all;
  std::string why;
  for (const TileId& id : sampled_places(info.grid)) {
    const auto tile = read_anywhere(tiles, id, deadline);
    if (!tile && tile.error().kind == MissingKind::failed) why = tile.error().why;
    if (!tile && tile.error().kind != MissingKind::broken) continue;
    const auto decoded =
        tile ? decode_numbers(*tile, numbers, info.grid.tile_px) : Result<Numbers, TileFailure>(tile.error());
    if (!decoded) {
      return Error{fmt::format("{}: tile {}/{}/{}: {}", info.name, id.level, id.x, id.y, decoded.error().why)};
    }
    add_inside(info.grid, id, *tile, *decoded, all);
  }
  NumberStatistics made = statistics_of(std::move(all), numbers.scale, numbers.offset);
  if (made.known > 0) return made;
  if (!why.empty()) return Error{fmt::format("{}; its numbers have no range to show", why)};
  return Error{fmt::format(
      "{}: none of the sampled pixels has data, so there is no range to show; give ‹stretch› MIN,MAX", info.name)};
}

}  // namespace terrella
