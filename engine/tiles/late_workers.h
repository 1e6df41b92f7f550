#pragma once

#include <algorithm>
#include <future>
#include <memory>
#include <thread>
#include <utility>

namespace terrella {

/// Keeps a worker that still reads for an owner that is gone. The end of the program waits for it. thread: any
void end_late(std::future<void> worker);

/// Destroys an owner of threads(). A call from one of these threads hands the owner to another thread, because no
/// thread can wait for its own end. An answer of a source may make such a call: it may release the last owner of the
/// source. thread: any
template <class Owner>
void end_owner(std::unique_ptr<Owner> owner) {
  const auto is_this = [](const std::jthread& one) { return one.get_id() == std::this_thread::get_id(); };
  if (!std::ranges::any_of(owner->threads(), is_this)) return;
  end_late(std::async(std::launch::async, [owner = std::move(owner)]() mutable { owner.reset(); }));
}

}  // namespace terrella
