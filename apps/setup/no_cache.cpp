#include "apps/setup/no_cache.h"
#include "apps/setup/console.h"

#include <fmt/core.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <system_error>

namespace terrella {

void say_without_cache(const Error& why) {
  static std::atomic_flag said;
  if (said.test_and_set()) return;
  print_message("terrella: {}; going on without a cache: nothing is kept for the next time\n", why.message);
}

bool can_write_into(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  std::string name = (folder / ".terrella-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) return false;
  rmdir(name.c_str());
  return true;
}

}  // namespace terrella
