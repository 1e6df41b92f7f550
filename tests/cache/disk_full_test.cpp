#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <fstream>

#include "cache/cache_test_support.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
using test::found;
using test::nth_tile;
using test::open_cache;
using test::tile_record;

constexpr std::size_t kSpace = 8UL << 20;
constexpr int kTiles = 2000;  // tiles of 8 kB: twice the space
constexpr std::size_t kTileBytes = 8000;

/// Stores tiles until there is no space for more, makes space, and stores the others.
void fill_and_go_on(const fs::path& file, const std::function<void()>& make_space) {
  std::vector<int> durable(kTiles, 0);
  const auto cache = open_cache(file, {.max_bytes = 0, .batch_tiles = 32, .max_queued_bytes = 1UL << 20});
  ASSERT_TRUE(cache);
  const auto store = [&](int n) {
    cache->store(nth_tile(9, n), tile_record(nth_tile(9, n), kTileBytes),
                 [&durable, n](const StoreStatus& status) { durable[static_cast<std::size_t>(n)] = status ? 1 : -1; });
  };
  for (int n = 0; n < kTiles; ++n) store(n);
  const Status full = cache->flush();
  ASSERT_FALSE(full);
  EXPECT_NE(full.error().message.find(file.string()), std::string::npos) << full.error().message;
  EXPECT_NE(full.error().message.find("make space"), std::string::npos) << full.error().message;
  EXPECT_GT(std::count(durable.begin(), durable.end(), 1), 100);
  EXPECT_GT(std::count(durable.begin(), durable.end(), -1), 100);

  make_space();
  for (int n = 0; n < kTiles; ++n) {
    if (durable[static_cast<std::size_t>(n)] < 0) {
      EXPECT_FALSE(found(*cache, nth_tile(9, n)));
      store(n);
    }
  }
  const Status more = cache->flush();
  ASSERT_TRUE(more) << more.error().message;
  for (int n = 0; n < kTiles; ++n) {
    const auto record = found(*cache, nth_tile(9, n));
    ASSERT_TRUE(record) << n;
    ASSERT_EQ(record->bytes, tile_record(nth_tile(9, n), kTileBytes).bytes) << n;
  }
  EXPECT_EQ(test::integrity(file), "ok");
}

/// A limit on the size of files, for as long as it lives.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(std::size_t bytes) : before_signal_(signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    EXPECT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  }
  ~FileSizeLimit() {
    lift();
    signal(SIGXFSZ, before_signal_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  void lift() const { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
  void (*before_signal_)(int);
};

TEST(CacheDiskFull, GoesOnAfterALimitOnTheFileSizeIsLifted) {
  const test::ScratchFolder folder;
  const FileSizeLimit limit(kSpace);
  fill_and_go_on(folder / "planet.gpkg", [&] { limit.lift(); });
}

/// A small file system in memory, where the system lets us have one.
class SmallDisk {
 public:
  explicit SmallDisk(const fs::path& folder) : folder_(folder) {
    fs::create_directories(folder_);
    const std::string options = "size=" + std::to_string(kSpace);
    mounted_ = mount("tmpfs", folder_.c_str(), "tmpfs", 0, options.c_str()) == 0;
  }
  ~SmallDisk() {
    if (mounted_) umount2(folder_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  [[nodiscard]] bool mounted() const { return mounted_; }
  [[nodiscard]] bool grow() const { return mount("tmpfs", folder_.c_str(), "tmpfs", MS_REMOUNT, "size=64m") == 0; }

 private:
  fs::path folder_;
  bool mounted_ = false;
};

TEST(CacheDiskFull, GoesOnAfterSpaceWasMadeOnASmallDisk) {
  const test::ScratchFolder folder;
  const SmallDisk disk(folder / "disk");
  if (!disk.mounted()) {
    // Only root may mount; the limit on the file size above takes the same path through the code.
    std::puts("no small disk can be mounted here");
    return;
  }
  fill_and_go_on(folder / "disk/planet.gpkg", [&] { EXPECT_TRUE(disk.grow()); });
}

}  // namespace
}  // namespace terrella
