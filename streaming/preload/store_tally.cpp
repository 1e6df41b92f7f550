#include "streaming/preload/store_tally.h"

#include <utility>

namespace terrella {

StoreTally::OnDurable StoreTally::sent(Kind kind, const TileId& id, std::size_t bytes) {
  ++open_;
  return
      [self = shared_from_this(), kind, id, bytes](const StoreStatus& status) { self->ended(kind, id, bytes, status); };
}

void StoreTally::ended(Kind kind, const TileId& id, std::size_t bytes, const StoreStatus& status) {
  if (status) {
    ++durable_[static_cast<std::size_t>(kind)];
    bytes_ += bytes;
    if (kind == Kind::tile && on_stored_) on_stored_(id);
  } else if (status.error().no_room) {
    const std::lock_guard lock(mutex_);
    without_room_.push_back(id);
    out_of_room_ = true;
  } else {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = status.error();
    failed_ = true;
  }
  --open_;
}

std::vector<TileId> StoreTally::take_without_room() {
  const std::lock_guard lock(mutex_);
  return std::exchange(without_room_, {});
}

Error StoreTally::error() const {
  const std::lock_guard lock(mutex_);
  return error_.value_or(Error{});
}

}  // namespace terrella
