#include "apps/process/open_files.h"

#include <sys/resource.h>

#include <algorithm>

namespace terrella {
namespace {

constexpr rlim_t kOtherFiles = 16;

}  // namespace

int connections_that_fit(int wanted) {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return wanted;
  const rlim_t needed = static_cast<rlim_t>(wanted) + kOtherFiles;
  if (limit.rlim_cur < needed) {
    rlimit raised = limit;
    raised.rlim_cur = std::min(needed, limit.rlim_max);
    if (setrlimit(RLIMIT_NOFILE, &raised) == 0) limit = raised;
  }
  if (limit.rlim_cur >= needed) return wanted;
  return limit.rlim_cur > kOtherFiles ? static_cast<int>(limit.rlim_cur - kOtherFiles) : 1;
}

}  // namespace terrella
