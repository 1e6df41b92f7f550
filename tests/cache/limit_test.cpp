#include <gtest/gtest.h>

#include <fstream>

#include "cache/cache_test_support.h"
#include "streaming/cache/cache_limit.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
using test::found;
using test::nth_tile;
using test::open_cache;
using test::tile_record;

constexpr std::uint64_t kLimit = 12UL << 20;
/// A cache file may miss its limit by this share.
constexpr double kLimitSlack = 0.05;
constexpr std::size_t kLimitedTileBytes = 11'000;

class CacheLimit : public testing::Test {
 protected:
  /// Stores tiles of a level until about `bytes` have gone in; returns how many.
  static int fill(TileCache& cache, std::uint64_t bytes, int level = 8) {
    int n = 0;
    for (std::uint64_t sum = 0; sum < bytes; ++n) {
      const std::size_t size = kLimitedTileBytes / 2 + static_cast<std::size_t>(n * 7919 % kLimitedTileBytes);
      cache.store(nth_tile(level, n), tile_record(nth_tile(level, n), size));
      sum += size;
    }
    EXPECT_TRUE(cache.flush());
    return n;
  }

  test::ScratchFolder folder_;
  const fs::path file_ = folder_ / "planet.gpkg";
};

TEST_F(CacheLimit, FileAndLogStayAtTheLimitWhileMoreComesIn) {
  const auto cache = open_cache(file_, {.max_bytes = kLimit});
  fill(*cache, kLimit);
  for (int round = 0; round < 12; ++round) {
    fill(*cache, kLimit / 8, 9 + round % 3);
    const auto size = static_cast<double>(test::size_on_disk(file_));
    EXPECT_LE(size, (1.0 + kLimitSlack) * static_cast<double>(kLimit)) << round;
    EXPECT_GE(size, (1.0 - kLimitSlack) * static_cast<double>(kLimit)) << round;
  }
  EXPECT_GT(cache->counts().evicted, 0U);
  EXPECT_EQ(test::integrity(file_), "ok");
}

TEST_F(CacheLimit, MostOfTheFileIsTiles) {
  const auto cache = open_cache(file_, {.max_bytes = kLimit});
  for (int round = 0; round < 4; ++round) fill(*cache, kLimit, 8 + round);
  // Rows of 11 kB in pages of 4 kB: the last page of each is half empty in the mean, and the log has its share.
  constexpr double kLeastShare = 0.7;
  const double bytes = std::stod(test::sql(file_, "SELECT sum(length(tile_data)) FROM tiles"));
  EXPECT_GE(bytes, kLeastShare * static_cast<double>(kLimit));
}

TEST_F(CacheLimit, TheLeastRecentlyUsedGoFirstAndRootsNever) {
  const auto cache = open_cache(file_, {.max_bytes = kLimit});
  const TileId roots[] = {nth_tile(0, 0), nth_tile(0, 1)};
  for (const TileId& root : roots) cache->store(root, tile_record(root));
  const int tiles = fill(*cache, kLimit / 2);
  // As if all had been used long ago, and the first of them found since.
  test::sql(file_, "UPDATE terrella_cache_tiles SET used = 1000 WHERE used IS NOT NULL");
  for (int n = 0; n < 50; ++n) ASSERT_TRUE(found(*cache, nth_tile(8, n)));
  fill(*cache, kLimit * 3 / 4, 9);
  for (const TileId& root : roots) EXPECT_TRUE(found(*cache, root));
  for (int n = 0; n < 50; ++n) EXPECT_TRUE(found(*cache, nth_tile(8, n))) << n;
  int left = 0;
  for (int n = 50; n < tiles; ++n) left += found(*cache, nth_tile(8, n)) ? 1 : 0;
  EXPECT_LT(left, tiles - 50);
  EXPECT_EQ(cache->counts().evicted, static_cast<std::uint64_t>(tiles - 50 - left));
}

TEST_F(CacheLimit, PinnedTilesStayAndWhatHasNoRoomIsSaidAndNotKept) {
  const auto pinned_record = [](const TileId& id) {
    CacheRecord record = tile_record(id, kLimitedTileBytes);
    record.pinned = true;
    return record;
  };
  const auto pinned_tiles = static_cast<int>(kLimit / kLimitedTileBytes * 3 / 2);
  {
    const auto cache = open_cache(file_);
    for (int n = 0; n < pinned_tiles; ++n) cache->store(nth_tile(8, n), pinned_record(nth_tile(8, n)));
  }
  const auto cache = open_cache(file_, {.max_bytes = kLimit});
  int no_room = 0;
  for (int n = 0; n < 300; ++n) {
    cache->store(nth_tile(9, n), tile_record(nth_tile(9, n), kLimitedTileBytes),
                 [&](const StoreStatus& status) { no_room += !status && status.error().no_room ? 1 : 0; });
    cache->store(nth_tile(10, n), test::missing_record(MissingKind::absent, "the sea", n));
  }
  ASSERT_TRUE(cache->flush());
  EXPECT_EQ(no_room, 300);
  EXPECT_FALSE(found(*cache, nth_tile(9, 0)));
  // A record as large as its predecessor goes in its place, however full the file is.
  cache->store(nth_tile(8, 0), tile_record(nth_tile(8, 0), kLimitedTileBytes, 1));
  ASSERT_TRUE(cache->flush());
  for (int n = 0; n < pinned_tiles; ++n) ASSERT_TRUE(found(*cache, nth_tile(8, n))) << n;
  EXPECT_EQ(test::sql(file_, "SELECT count(*) FROM terrella_cache_tiles WHERE used IS NULL"),
            std::to_string(pinned_tiles));

  for (std::int64_t x = 0; x < columns(test::planet().grid, 8); ++x) cache->pin({8, x, 0}, 255, false);
  ASSERT_TRUE(cache->flush());
  EXPECT_EQ(cache->counts().pins_changed, static_cast<std::uint64_t>(pinned_tiles));
  fill(*cache, kLimit / 4, 9);
  EXPECT_TRUE(found(*cache, nth_tile(9, 0)));
  EXPECT_GT(cache->counts().evicted, 0U);
}

TEST_F(CacheLimit, SpaceIsGivenBackWhenTheLimitIsLowered) {
  fill(*open_cache(file_), 2 * kLimit);
  EXPECT_GT(fs::file_size(file_), 2 * kLimit);
  const auto cache = open_cache(file_, {.max_bytes = kLimit});
  fill(*cache, kLimit, 9);
  EXPECT_LE(static_cast<double>(test::size_on_disk(file_)), (1.0 + kLimitSlack) * static_cast<double>(kLimit));
}

TEST_F(CacheLimit, MissingGoToo) {
  const auto cache = open_cache(file_, {.max_bytes = 1UL << 20});
  for (int n = 0; n < 20'000; ++n) {
    cache->store(nth_tile(10, n), test::missing_record(MissingKind::absent, "the sea, and more of the sea", n));
  }
  ASSERT_TRUE(cache->flush());
  EXPECT_LE(test::size_on_disk(file_), (1UL << 20) * 5 / 4);
  EXPECT_TRUE(found(*cache, nth_tile(10, 19'999)));
  EXPECT_FALSE(found(*cache, nth_tile(10, 0)));
}

TEST_F(CacheLimit, ReadsAreNotWrites) {
  const auto cache = open_cache(file_);
  fill(*cache, 1UL << 20);
  const std::string before = test::sql(file_, "PRAGMA data_version");
  const std::uintmax_t log = fs::file_size(file_.string() + "-wal");
  for (int round = 0; round < 20; ++round) {
    for (int n = 0; n < 50; ++n) ASSERT_TRUE(found(*cache, nth_tile(8, n)));
  }
  ASSERT_TRUE(cache->flush());
  EXPECT_EQ(fs::file_size(file_.string() + "-wal"), log);
}

TEST(CacheBudgetTest, LogAndBatchAreSmallAgainstTheLimit) {
  constexpr std::int64_t kPage = 4096;
  for (const std::uint64_t limit : {16UL << 20, 1UL << 30, 100UL << 30}) {
    const CacheBudget budget = cache_budget(limit, kPage);
    EXPECT_LE(budget.log_bytes + budget.batch_bytes, limit / 40);
    EXPECT_LE(static_cast<std::uint64_t>(budget.file_pages * kPage) + 2 * budget.log_bytes, limit);
    EXPECT_GE(static_cast<std::uint64_t>(budget.file_pages * kPage), limit / 100 * 96);
    EXPECT_EQ(pages_over(budget, budget.file_pages, 10, 10), 0);
    EXPECT_EQ(pages_over(budget, budget.file_pages, 10, 25), 15);
  }
  EXPECT_EQ(pages_over(cache_budget(0, kPage), 1'000'000, 0, 100), 0);
}

}  // namespace
}  // namespace terrella
