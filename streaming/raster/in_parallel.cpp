#include "streaming/raster/in_parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace terrella {

int thread_count(int jobs) {
  return jobs > 0 ? jobs : static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 64U));
}

void in_parallel(int jobs, std::int64_t count, const std::function<void(std::int64_t)>& work) {
  std::atomic<std::int64_t> next{0};
  std::mutex mutex;
  std::exception_ptr thrown;
  const auto run = [&] {
    try {
      for (std::int64_t i = next++; i < count; i = next++) work(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!thrown) thrown = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> threads;
    const std::int64_t helpers = std::min<std::int64_t>(jobs, count) - 1;
    for (std::int64_t i = 0; i < helpers; ++i) threads.emplace_back(run);
    run();
  }
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace terrella
