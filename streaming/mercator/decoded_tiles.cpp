#include "streaming/mercator/decoded_tiles.h"

#include <utility>

namespace terrella {

/// Marks a tile as being decoded. The destructor removes the mark, also after an exception.
class DecodedTiles::Turn {
 public:
  Turn(DecodedTiles& tiles, const TileId& id) : tiles_(tiles), id_(id) {}
  ~Turn() {
    {
      const std::lock_guard lock(tiles_.mutex_);
      tiles_.under_way_.erase(id_);
    }
    tiles_.done_.notify_all();
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  DecodedTiles& tiles_;
  const TileId id_;
};

std::shared_ptr<const Image> DecodedTiles::find(const TileId& id) {
  const std::lock_guard lock(mutex_);
  return held(id);
}

DecodedTiles::Decoded DecodedTiles::get(const TileId& id, const Decode& decode) {
  {
    std::unique_lock lock(mutex_);
    done_.wait(lock, [&] { return !under_way_.contains(id); });
    if (auto picture = held(id)) return picture;
    under_way_.insert(id);
  }
  const Turn turn(*this, id);
  Result<Image, TileFailure> decoded = decode();
  if (!decoded) return decoded.error();
  auto picture = std::make_shared<const Image>(*std::move(decoded));
  hold(id, picture);
  return std::shared_ptr<const Image>(std::move(picture));
}

std::shared_ptr<const Image> DecodedTiles::held(const TileId& id) {
  const auto place = places_.find(id);
  if (place == places_.end()) return nullptr;
  tiles_.splice(tiles_.begin(), tiles_, place->second);
  return place->second->picture;
}

void DecodedTiles::hold(const TileId& id, std::shared_ptr<const Image> picture) {
  const std::lock_guard lock(mutex_);
  bytes_ += picture->rgba.size();
  tiles_.push_front({id, std::move(picture)});
  places_[id] = tiles_.begin();
  while (bytes_ > max_bytes_) {
    bytes_ -= tiles_.back().picture->rgba.size();
    places_.erase(tiles_.back().id);
    tiles_.pop_back();
  }
}

}  // namespace terrella
