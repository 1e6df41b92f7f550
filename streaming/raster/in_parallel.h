#pragma once

#include <cstdint>
#include <functional>

namespace terrella {

/// Number of threads for a `jobs` option: 0 means one for each core. thread: any
[[nodiscard]] int thread_count(int jobs);

/// Calls work(0) … work(count - 1) on at most `jobs` threads, the caller's among them, and returns when all are done.
/// Rethrows the first exception (std::bad_alloc). thread: any
void in_parallel(int jobs, std::int64_t count, const std::function<void(std::int64_t)>& work);

}  // namespace terrella
