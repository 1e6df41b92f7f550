#include "streaming/warp/stored_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tiles/height_decoder.h"

namespace terrella {
namespace {

Result<Block, TileFailure> colours_of(const EncodedTile& encoded, int largest_side_px) {
  if (encoded.make_picture) {
    auto made = encoded.make_picture();
    if (!made) return made.error();
    return Block(*std::move(made));
  }
  DecodeLimits limits;
  limits.max_side_px = std::max(largest_side_px, 1024);
  auto image = decode_image(encoded.bytes, limits);
  if (!image) return TileFailure{MissingKind::broken, image.error().message};
  return Block(*std::move(image));
}

Result<Block, TileFailure> numbers_of(const EncodedTile& encoded, const NumberInfo& info, int side_px) {
  auto numbers = encoded.make_numbers ? encoded.make_numbers() : decode_numbers(encoded, info, side_px);
  if (!numbers) return numbers.error();
  if (encoded.number_scale != 1.0 || encoded.number_offset != 0.0) {
    for (float& number : numbers->values) {
      number = static_cast<float>(number * encoded.number_scale + encoded.number_offset);
    }
  }
  return Block(*std::move(numbers));
}

}  // namespace

FoundBlock FoundBlock::of(Result<EncodedTile, TileFailure>&& answer) {
  if (!answer) return {.encoded = nullptr, .decoded = nullptr, .failure = answer.error()};
  return {.encoded = std::make_shared<const EncodedTile>(*std::move(answer)), .decoded = nullptr, .failure = {}};
}

StoredBlocks::StoredBlocks(std::shared_ptr<RasterSource> raster, std::vector<WarpLevel> levels, BlockNames names,
                           std::size_t decoded_bytes)
    : raster_(std::move(raster)),
      levels_(std::move(levels)),
      names_(std::move(names)),
      decoded_(std::make_unique<DecodedBlocks>(decoded_bytes)) {}

TileId StoredBlocks::stored(const TileId& block) const {
  return {.level = level(block.level).stored, .x = block.x, .y = block.y};
}

FoundBlock StoredBlocks::find(const TileId& block) const {
  if (auto decoded = decoded_->find(block)) return {.encoded = nullptr, .decoded = std::move(decoded), .failure = {}};
  FoundBlock found = FoundBlock::of(raster_->read(stored(block)));
  if (level(block.level).halvings == 0 || !found.encoded) return found;
  // A tile may need thousands of blocks that it reduces. Reduced, they take less memory than encoded.
  auto reduced = decode(block, found);
  if (!reduced) return {.encoded = nullptr, .decoded = nullptr, .failure = reduced.error()};
  return {.encoded = nullptr, .decoded = *std::move(reduced), .failure = {}};
}

DecodedBlocks::Decoded StoredBlocks::decode(const TileId& block, const FoundBlock& found) const {
  if (found.decoded) return found.decoded;
  return decoded_->get(block, [&]() -> Result<Block, TileFailure> {
    auto whole = decode_whole(block, *found.encoded);
    if (!whole) return whole;
    const int halvings = level(block.level).halvings;
    return halvings > 0 ? reduced(*whole, halvings) : *std::move(whole);
  });
}

Result<Block, TileFailure> StoredBlocks::decode_whole(const TileId& block, const EncodedTile& encoded) const {
  const RasterInfo& info = raster_->info();
  const TileId id = stored(block);
  const RasterLevel& from = info.levels[static_cast<std::size_t>(id.level)];
  auto whole = info.numbers ? numbers_of(encoded, *info.numbers, from.block_width_px)
                            : colours_of(encoded, std::max(from.block_width_px, from.block_height_px));
  if (!whole) return whole;
  const std::int64_t width = std::min<std::int64_t>(from.block_width_px, from.width_px - id.x * from.block_width_px);
  const std::int64_t height =
      std::min<std::int64_t>(from.block_height_px, from.height_px - id.y * from.block_height_px);
  const int is_width = width_px(*whole), is_height = height_px(*whole);
  if (is_width >= width && is_height >= height && is_width <= from.block_width_px &&
      is_height <= from.block_height_px) {
    return whole;
  }
  return TileFailure{MissingKind::broken, fmt::format("it is {}×{} pixels, the tile set says {}×{}", is_width,
                                                      is_height, from.block_width_px, from.block_height_px)};
}

Result<double, TileFailure> StoredBlocks::value_at(const CrsPoint& pixel) const {
  // A place that the projection does not reach is infinite; pixel numbers beyond 2^31 do not exist.
  const auto number = [](double at) { return std::isfinite(at) ? static_cast<std::int64_t>(std::floor(at)) : -1; };
  return raster_->value_at(number(pixel.x), number(pixel.y));
}

std::string StoredBlocks::named(const TileId& block, const std::string& why) const {
  return fmt::format("made of the {} {}/{}/{}: {}", names_.noun, stored(block).level + names_.first_level, block.x,
                     block.y, why);
}

/// Marks a block as being decoded. The destructor removes the mark, also after an exception.
class DecodedBlocks::Turn {
 public:
  Turn(DecodedBlocks& blocks, const TileId& id) : blocks_(blocks), id_(id) {}
  ~Turn() {
    {
      const std::lock_guard lock(blocks_.mutex_);
      blocks_.under_way_.erase(id_);
    }
    blocks_.done_.notify_all();
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  DecodedBlocks& blocks_;
  const TileId id_;
};

std::shared_ptr<const Block> DecodedBlocks::find(const TileId& id) {
  const std::lock_guard lock(mutex_);
  return held(id);
}

DecodedBlocks::Decoded DecodedBlocks::get(const TileId& id, const Decode& decode) {
  {
    std::unique_lock lock(mutex_);
    done_.wait(lock, [&] { return !under_way_.contains(id); });
    if (auto block = held(id)) return block;
    under_way_.insert(id);
  }
  const Turn turn(*this, id);
  Result<Block, TileFailure> decoded = decode();
  if (!decoded) return decoded.error();
  auto block = std::make_shared<const Block>(*std::move(decoded));
  hold(id, block);
  return std::shared_ptr<const Block>(std::move(block));
}

std::shared_ptr<const Block> DecodedBlocks::held(const TileId& id) {
  const auto place = places_.find(id);
  if (place == places_.end()) return nullptr;
  blocks_.splice(blocks_.begin(), blocks_, place->second);
  return place->second->block;
}

void DecodedBlocks::hold(const TileId& id, std::shared_ptr<const Block> block) {
  const std::lock_guard lock(mutex_);
  bytes_ += size_bytes(*block);
  blocks_.push_front({id, std::move(block)});
  places_[id] = blocks_.begin();
  while (bytes_ > max_bytes_) {
    bytes_ -= size_bytes(*blocks_.back().block);
    places_.erase(blocks_.back().id);
    blocks_.pop_back();
  }
}

}  // namespace terrella
