#include "streaming/remote/reply_rules.h"

#include <algorithm>
#include <new>
#include <span>
#include <string_view>
#include <utility>

#include "streaming/sets/tile_check.h"
#include "tiles/height_decoder.h"

namespace terrella {
namespace {

Status check_decodes(const TileSetInfo& info, const TileSides& sides, std::span<const std::byte> bytes) {
  const bool cut = sides.least_width_px < sides.most_px || sides.least_height_px < sides.most_px;
  if (info.numbers && !cut) {
    const auto numbers = decode_numbers({.bytes = {bytes.begin(), bytes.end()}}, *info.numbers, sides.most_px);
    return numbers ? Status(Done{}) : Error{numbers.error().why};
  }
  if (sides.floats) return Done{};
  const auto image = decode_image(bytes);
  return image ? Status(Done{}) : image.error();
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
  if (Status fits = check_tile(bytes, sides); !fits) return fits;
  return check_decodes(info, sides, bytes);
}

}  // namespace

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

void check_body(const TileSetInfo& info, const TileId& id, HttpReply& reply) {
  if (reply.outcome != HttpOutcome::content || reply.body.empty()) return;
  const auto end = [&reply](HttpOutcome outcome, std::string why) {
    reply.outcome = outcome;
    reply.why = std::move(why);
    reply.body.clear();
  };
  try {
    if (Status good = check_answer(info, id, reply.body); !good) end(HttpOutcome::broken, good.error().message);
  } catch (const std::bad_alloc&) {
    end(HttpOutcome::failed, "there is not enough memory to decode it");
  }
}

}  // namespace terrella
