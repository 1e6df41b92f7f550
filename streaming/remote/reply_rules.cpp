#include "streaming/remote/reply_rules.h"

#include <algorithm>
#include <string_view>

#include "streaming/sets/tile_check.h"

namespace terrella {

void apply_reply_rules(const RemoteTileSet& set, HttpReply& reply) {
  const bool listed = std::ranges::find(set.missing_statuses, reply.status) != set.missing_statuses.end();
  const bool is_content = reply.outcome == HttpOutcome::content;
  if (listed && reply.outcome != HttpOutcome::not_modified) reply.outcome = HttpOutcome::nothing;
  if (!is_content || !set.exception_is_missing) return;
  const std::string told =
      server_exception(std::string_view(reinterpret_cast<const char*>(reply.body.data()), reply.body.size()));
  if (told.empty()) return;
  reply.outcome = HttpOutcome::nothing;
  reply.why = "the server answers with an exception: " + told;
}

Status check_answer(const TileSetInfo& info, const TileId& id, std::span<const std::byte> bytes) {
  const TileGrid& grid = info.grid;
  TileSides sides{.least_width_px = grid.tile_px,
                  .least_height_px = grid.tile_px,
                  .most_px = grid.tile_px,
                  .floats = info.numbers && info.numbers->floats};
  if (info.square) {
    const TileBounds tile = tile_bounds(grid, id);
    if (tile.east_deg > grid.bounds.east.deg()) sides.least_width_px = 1;
    if (tile.south_deg < grid.bounds.south.deg()) sides.least_height_px = 1;
  }
  return check_tile(bytes, sides);
}

}  // namespace terrella
