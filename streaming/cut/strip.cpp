#include "streaming/cut/strip.h"

namespace terrella {

std::shared_ptr<Strip> StripPool::lend(const Strip& shape) {
  const std::size_t bytes = shape.stride_bytes() * static_cast<std::size_t>(shape.tile_px);
  auto strip = std::make_unique<Strip>(shape);
  {
    std::unique_lock lock(mutex_);
    returned_.wait(lock, [&] { return lent_bytes_ == 0 || lent_bytes_ + bytes <= max_bytes_; });
    lent_bytes_ += bytes;
    if (const auto found = free_.find(bytes); found != free_.end()) {
      strip->rgba = std::move(found->second);
      free_.erase(found);
    }
  }
  strip->rgba.resize(bytes);
  return {strip.release(), [this](Strip* done) { take_back(done); }};
}

void StripPool::take_back(Strip* strip) {
  const std::unique_ptr<Strip> owner(strip);
  {
    const std::scoped_lock lock(mutex_);
    lent_bytes_ -= owner->rgba.size();
    const std::size_t bytes = owner->rgba.size();
    free_.emplace(bytes, std::move(owner->rgba));
  }
  returned_.notify_all();
}

}  // namespace terrella
