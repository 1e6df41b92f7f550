// A process that uses a cache, for tests of several at once and of sudden ends.
//   cache_worker write FILE SEED            stores tiles for ever, and says the number of each once it is durable
//   cache_worker share FILE SEED SECONDS    stores, finds, renews and flushes; any error ends it with 1
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include "cache/cache_test_support.h"

namespace {

using namespace terrella;
using test::kSource;
using test::nth_tile;
using test::planet;
using test::tile_record;

constexpr int kTiles = 4000;

[[noreturn]] void fail(const std::string& why) {
  std::fprintf(stderr, "%s\n", why.c_str());
  std::_Exit(1);
}

std::shared_ptr<TileCache> open_or_fail(const std::string& file, const CacheOptions& options) {
  auto cache = TileCache::open(file, planet(), kSource, options);
  if (!cache) fail(cache.error().message);
  if (!(*cache)->set_aside().empty()) fail("set aside: " + (*cache)->set_aside().string());
  return *cache;
}

/// One write for each number: a line is said whole or not at all.
void say(int number) {
  std::array<char, 32> line{};
  const int length = std::snprintf(line.data(), line.size(), "%9d\n", number);
  if (write(STDOUT_FILENO, line.data(), static_cast<std::size_t>(length)) != length) std::_Exit(2);
}

[[noreturn]] void write_for_ever(const std::string& file, int seed) {
  const auto cache = open_or_fail(file, {.max_bytes = 0, .batch_tiles = 16, .max_queued_bytes = 1UL << 20});
  for (int n = seed * 100'000;; ++n) {
    cache->store(nth_tile(10, n), tile_record(nth_tile(10, n)), [n](const StoreStatus& status) {
      if (!status) fail(status.error().message);
      say(n);
    });
  }
}

void use_once(TileCache& cache, std::mt19937& random) {
  const TileId id = nth_tile(9, static_cast<int>(random() % kTiles));
  const auto checked = [](const StoreStatus& status) {
    if (!status) fail(status.error().message);
  };
  switch (random() % 8) {
    case 0:
      return cache.renew(id, 5000, 6000, checked);
    case 1:
      return cache.store(id, test::missing_record(MissingKind::failed, "busy"), checked);
    case 2:
    case 3:
    case 4:
      return cache.store(id, tile_record(id, 8000), checked);
    default:
      break;
  }
  const auto found = cache.find(id);
  if (!found) fail(found.error().message);
  if (*found && !(*found)->missing && (*found)->bytes != tile_record(id, 8000).bytes) fail("another tile's bytes");
}

void share(const std::string& file, int seed, double seconds) {
  std::mt19937 random(static_cast<unsigned>(seed));
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < end) {
    const auto cache = open_or_fail(file, {.max_bytes = 16UL << 20});
    for (int n = 0; n < 2000 && std::chrono::steady_clock::now() < end; ++n) use_once(*cache, random);
    if (const Status flushed = cache->flush(); !flushed) fail(flushed.error().message);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const std::string what = argv[1];
  if (what == "write") write_for_ever(argv[2], std::atoi(argv[3]));
  if (what != "share" || argc < 5) return 2;
  share(argv[2], std::atoi(argv[3]), std::atof(argv[4]));
  return 0;
}
