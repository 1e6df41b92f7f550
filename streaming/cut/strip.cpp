#include "streaming/cut/strip.h"

#include <sys/mman.h>

#include <iterator>
#include <new>
#include <utility>

namespace terrella {

void* take_pages(std::size_t bytes) {
  void* pages = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages == MAP_FAILED) throw std::bad_alloc();
  return pages;
}

void give_pages_back(void* pages, std::size_t bytes) { munmap(pages, bytes); }

std::shared_ptr<Strip> StripPool::lend(const Strip& shape) {
  const std::size_t bytes = shape.stride_bytes() * static_cast<std::size_t>(shape.tile_px);
  auto strip = std::make_unique<Strip>(shape);
  std::vector<Pixels> dropped;
  {
    std::unique_lock lock(mutex_);
    returned_.wait(lock, [&] { return lent_bytes_ == 0 || lent_bytes_ + bytes <= max_bytes_; });
    lent_bytes_ += bytes;
    if (const auto found = free_.find(bytes); found != free_.end()) {
      strip->rgba = std::move(found->second);
      free_bytes_ -= bytes;
      free_.erase(found);
    }
    dropped = drop_free();
  }
  dropped.clear();
  strip->rgba.resize(bytes);
  return {strip.release(), [this](Strip* done) { take_back(done); }};
}

std::size_t StripPool::held_bytes() const {
  const std::scoped_lock lock(mutex_);
  return lent_bytes_ + free_bytes_;
}

/// Removes kept memory over the limit, largest first.
std::vector<StripPool::Pixels> StripPool::drop_free() {
  std::vector<Pixels> dropped;
  while (!free_.empty() && lent_bytes_ + free_bytes_ > max_bytes_) {
    const auto largest = std::prev(free_.end());
    free_bytes_ -= largest->first;
    dropped.push_back(std::move(largest->second));
    free_.erase(largest);
  }
  return dropped;
}

void StripPool::take_back(Strip* strip) {
  const std::unique_ptr<Strip> owner(strip);
  {
    const std::scoped_lock lock(mutex_);
    const std::size_t bytes = owner->rgba.size();
    lent_bytes_ -= bytes;
    free_bytes_ += bytes;
    free_.emplace(bytes, std::move(owner->rgba));
  }
  returned_.notify_all();
}

}  // namespace terrella
