#include "streaming/warp/decoded_blocks.h"

#include <utility>

namespace terrella {

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
