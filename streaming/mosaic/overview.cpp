#include "streaming/mosaic/overview.h"

#include <zlib.h>

#include <algorithm>
#include <utility>

#include "streaming/mosaic/area_mean.h"
#include "streaming/mosaic/sheet_tiles.h"

namespace terrella {
namespace {

/// Heights shrink by as much at higher levels, which take three times as long.
constexpr int kFast = 1;

}  // namespace

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

std::vector<std::byte> pack_pixels(const Block& block) {
  if (const auto* const image = std::get_if<Image>(&block)) {
    auto png = encode_png(*image);
    return png ? *std::move(png) : std::vector<std::byte>();
  }
  const std::vector<float>& values = std::get<Numbers>(block).values;
  const auto size = static_cast<uLong>(values.size() * sizeof(float));
  uLongf packed = compressBound(size);
  std::vector<std::byte> bytes(packed);
  const int done = compress2(reinterpret_cast<Bytef*>(bytes.data()), &packed,
                             reinterpret_cast<const Bytef*>(values.data()), size, kFast);
  bytes.resize(done == Z_OK ? packed : 0);
  return bytes;
}

Result<Block> unpack_pixels(std::span<const std::byte> bytes, int side_px, bool numbers) {
  if (!numbers) {
    auto image = decode_image(bytes);
    if (!image) return image.error();
    if (image->width_px != side_px || image->height_px != side_px) return Error{"a kept tile has another size"};
    return Block(*std::move(image));
  }
  Numbers made{side_px, side_px,
               std::vector<float>(static_cast<std::size_t>(side_px) * static_cast<std::size_t>(side_px))};
  auto size = static_cast<uLongf>(made.values.size() * sizeof(float));
  const uLongf whole = size;
  const int done = uncompress(reinterpret_cast<Bytef*>(made.values.data()), &size,
                              reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()));
  if (done != Z_OK || size != whole) return Error{"a kept tile is damaged"};
  return Block(std::move(made));
}

}  // namespace terrella
