#include "tiles/late_workers.h"

#include <chrono>
#include <mutex>
#include <utility>
#include <vector>

namespace terrella {

void end_late(std::future<void> worker) {
  static std::mutex mutex;
  static std::vector<std::future<void>> workers;  // the destructor of a future waits for its thread
  const std::lock_guard lock(mutex);
  std::erase_if(workers, [](const std::future<void>& late) {
    return late.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  });
  workers.push_back(std::move(worker));
}

}  // namespace terrella
