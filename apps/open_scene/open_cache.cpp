#include "apps/open_scene/open_cache.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "apps/process/console.h"

namespace terrella {

Result<std::shared_ptr<TileCache>, CacheOpenError> open_cache(const std::string& who, const std::filesystem::path& file,
                                                              const TileSetInfo& info, const std::string& source_key,
                                                              std::size_t max_mb,
                                                              std::function<void(const Error&)> on_failed) {
  CacheOptions options{.max_bytes = megabytes(max_mb)};
  options.on_locked = [who, name = file.string()] {
    print_message("{}: {} is locked by another program; waiting for it, a minute at most\n", who, name);
  };
  options.on_failed = std::move(on_failed);
  auto cache = TileCache::open(file, info, source_key, options);
  if (cache && !(*cache)->set_aside().empty()) {
    print_message("{}: {} was damaged; it was renamed to {}, and a new file was started\n", who, file.string(),
                  (*cache)->set_aside().string());
  }
  return cache;
}

std::filesystem::path file_of_time(const std::filesystem::path& cache, const std::string& time) {
  if (time.empty()) return cache;
  std::string name = time;
  const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '.'; };
  std::ranges::replace_if(
      name, [&](unsigned char c) { return !is_plain(c); }, '-');
  return cache.parent_path() / fmt::format("{}.{}{}", cache.stem().string(), name, cache.extension().string());
}

void say_without_cache(const Error& why) {
  static std::atomic_flag said;
  if (said.test_and_set()) return;
  print_message("terrella: {}; continuing without a cache, so the next run requests the tiles again\n", why.message);
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
