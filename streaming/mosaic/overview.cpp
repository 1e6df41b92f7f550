#include "streaming/mosaic/overview.h"

#include <algorithm>
#include <utility>

#include "streaming/mosaic/area_mean.h"
#include "streaming/mosaic/kept_pixels.h"
#include "streaming/mosaic/sheet_tiles.h"

namespace terrella {

Overview::Overview(Parts parts)
    : parts_(std::move(parts)), desk_({.work = [this](const TileWish& wish) { return work(wish); }}) {}

EncodedTile Overview::encoded(std::shared_ptr<const Block> block) const {
  EncodedTile tile;
  if (parts_.numbers) {
    tile.make_numbers = [block = std::move(block)]() -> Result<Numbers, TileFailure> {
      return std::get<Numbers>(*block);
    };
  } else {
    tile.make_picture = [block = std::move(block)]() -> Result<Image, TileFailure> { return std::get<Image>(*block); };
  }
  return tile;
}

Result<EncodedTile, TileFailure> Overview::read(const TileId& id, std::uint64_t mark) {
  if (auto block = made_.find(id)) return encoded(std::move(block));
  const auto bytes = parts_.store != nullptr ? parts_.store->tile(id, mark) : std::nullopt;
  auto block = bytes ? unpack_pixels(*bytes, parts_.tile_px, parts_.numbers) : Result<Block>(Error{});
  if (!block) return TileFailure{MissingKind::remote, {}};
  return encoded(std::make_shared<const Block>(*std::move(block)));
}

DecodedBlocks::Decoded Overview::pixels(const TileId& id, std::uint64_t wish) {
  if (!desk_.is_wanted(wish)) return TileFailure{MissingKind::failed, "the overview of the files is not ready"};
  const OverviewTile tile = parts_.look(id);
  if (tile.is_empty) return TileFailure{MissingKind::blank, {}};
  if (!tile.is_direct) return made_.get(id, [&] { return make(id, tile.mark, wish); });
  const auto direct = parts_.make_direct(id);
  auto decoded = direct ? decode_tile(*direct) : Result<Block, TileFailure>(direct.error());
  if (!decoded) return decoded.error();
  return std::make_shared<const Block>(*std::move(decoded));
}

Result<Block, TileFailure> Overview::make(const TileId& id, std::uint64_t mark, std::uint64_t wish) {
  const auto bytes = parts_.store != nullptr ? parts_.store->tile(id, mark) : std::nullopt;
  auto kept = bytes ? unpack_pixels(*bytes, parts_.tile_px, parts_.numbers) : Result<Block>(Error{});
  if (kept) return *std::move(kept);
  const int side = parts_.tile_px;
  AreaMean mean({.width = side, .height = side}, parts_.numbers);
  for (int quarter = 0; quarter < 4; ++quarter) {
    const int x = quarter % 2, y = quarter / 2;
    const auto child = pixels({.level = id.level + 1, .x = 2 * id.x + x, .y = 2 * id.y + y}, wish);
    if (!child && child.error().kind == MissingKind::failed) return child.error();
    if (!child) continue;  // nothing there, or named already
    mean.add(**child, 0, 0,
             {.corner_x = 0.5 * side * x,
              .corner_y = 0.5 * side * y,
              .size_x = 0.5,
              .size_y = 0.5,
              .width_px = side,
              .height_px = side});
  }
  mean.end_file();
  Block made = mean.finish();
  if (parts_.store != nullptr) {
    const auto packed = pack_pixels(made);
    if (!packed.empty()) parts_.store->keep_tile(id, mark, packed);
  }
  return made;
}

Result<EncodedTile, TileFailure> Overview::work(const TileWish& wish) {
  std::call_once(begun_, parts_.begin);
  auto block = pixels(wish.id, wish.number);
  if (!block) return block.error();
  return encoded(*std::move(block));
}

}  // namespace terrella
