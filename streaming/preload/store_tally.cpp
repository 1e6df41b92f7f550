#include "streaming/preload/store_tally.h"

namespace terrella {

StoreTally::OnDurable StoreTally::sent(Kind kind, const TileId& id, std::size_t bytes) {
  ++open_;
  return [self = shared_from_this(), kind, id, bytes](const Status& status) { self->ended(kind, id, bytes, status); };
}

void StoreTally::ended(Kind kind, const TileId& id, std::size_t bytes, const Status& status) {
  if (status) {
    ++durable_[static_cast<std::size_t>(kind)];
    bytes_ += bytes;
    if (kind == Kind::tile && on_stored_) on_stored_(id);
  } else {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = status.error();
    failed_ = true;
  }
  --open_;
}

Error StoreTally::error() const {
  const std::lock_guard lock(mutex_);
  return error_.value_or(Error{});
}

}  // namespace terrella
