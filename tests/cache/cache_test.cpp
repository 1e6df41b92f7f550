#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <thread>

#include "cache/cache_test_support.h"
#include "streaming/sets/open_tile_set.h"
#include "tiles/tile_source.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
using test::found;
using test::missing_record;
using test::nth_tile;
using test::open_cache;
using test::tile_record;

void expect_same(const std::optional<CacheRecord>& got, const CacheRecord& expected) {
  ASSERT_TRUE(got);
  EXPECT_EQ(got->missing, expected.missing);
  EXPECT_EQ(got->bytes, expected.bytes);
  EXPECT_EQ(got->why, expected.why);
  EXPECT_EQ(got->etag, expected.etag);
  EXPECT_EQ(got->last_modified, expected.last_modified);
  EXPECT_EQ(got->stored_unix_s, expected.stored_unix_s);
  EXPECT_EQ(got->expires_unix_s, expected.expires_unix_s);
}

class Cache : public testing::Test {
 protected:
  test::ScratchFolder folder_;
  const fs::path file_ = folder_ / "planet.gpkg";
};

TEST_F(Cache, FindsWhatWasStoredBeforeAndAfterItIsDurableAndAfterOpeningAgain) {
  const TileId id = nth_tile(3, 17);
  {
    const auto cache = open_cache(file_);
    EXPECT_FALSE(found(*cache, id));
    cache->store(id, tile_record(id));
    expect_same(found(*cache, id), tile_record(id));
    ASSERT_TRUE(cache->flush());
    expect_same(found(*cache, id), tile_record(id));
    EXPECT_EQ(cache->counts().stored, 1U);
    EXPECT_EQ(cache->counts().file_bytes, test::size_on_disk(file_));
    EXPECT_TRUE(cache->set_aside().empty());
  }
  expect_same(found(*open_cache(file_), id), tile_record(id));
}

TEST_F(Cache, PeekKnowsAllButTheBytes) {
  const TileId id = nth_tile(3, 17);
  const auto cache = open_cache(file_);
  cache->store(id, tile_record(id));
  CacheRecord expected = tile_record(id);
  expected.bytes.clear();
  expect_same(*cache->peek(id), expected);
  ASSERT_TRUE(cache->flush());
  expect_same(*cache->peek(id), expected);
}

TEST_F(Cache, TellsWhenARecordIsDurable) {
  std::atomic<int> durable = 0;
  const auto cache = open_cache(file_);
  for (int n = 0; n < 1000; ++n) {
    const TileId id = nth_tile(5, n);
    cache->store(id, tile_record(id, 100), [&, id](const StoreStatus& status) {
      EXPECT_TRUE(status);
      const std::string rows =
          test::sql(file_, "SELECT count(*) FROM tiles WHERE zoom_level = 5 AND tile_column = " + std::to_string(id.x) +
                               " AND tile_row = " + std::to_string(id.y));
      EXPECT_EQ(rows, "1");
      ++durable;
    });
    if (n % 100 == 0) {
      ASSERT_TRUE(cache->flush());
    }
  }
  ASSERT_TRUE(cache->flush());
  EXPECT_EQ(durable, 1000);
}

TEST_F(Cache, KeepsEveryKindOfMissingWithItsReasonAndItsLife) {
  const MissingKind kinds[] = {MissingKind::absent, MissingKind::blank, MissingKind::broken, MissingKind::failed};
  const auto check = [&](TileCache& cache) {
    for (int n = 0; n < 4; ++n) {
      const CacheRecord expected = missing_record(kinds[n], "why " + std::to_string(n), 5000 + n);
      expect_same(found(cache, nth_tile(4, n)), expected);
      EXPECT_TRUE(is_fresh(expected, 5000 + n + 59));
      EXPECT_FALSE(is_fresh(expected, 5000 + n + 60));
    }
  };
  {
    const auto cache = open_cache(file_);
    for (int n = 0; n < 4; ++n) {
      cache->store(nth_tile(4, n), missing_record(kinds[n], "why " + std::to_string(n), 5000 + n));
    }
    check(*cache);
    ASSERT_TRUE(cache->flush());
    check(*cache);
  }
  check(*open_cache(file_));
}

TEST_F(Cache, TheLastRecordOfAPlaceIsKept) {
  const TileId id = nth_tile(4, 5);
  const auto cache = open_cache(file_);
  const CacheRecord records[] = {missing_record(MissingKind::absent, "not yet"),
                                 missing_record(MissingKind::blank, "sea"), tile_record(id, 3000, 1),
                                 tile_record(id, 9000, 2), tile_record(id, 2000, 3)};
  for (const bool flushed : {false, true}) {
    ASSERT_TRUE(cache->flush());
    test::sql(file_, "DELETE FROM tiles; DELETE FROM terrella_cache_tiles");
    for (const CacheRecord& record : records) {
      cache->store(id, record);
      if (flushed) {
        ASSERT_TRUE(cache->flush());
      }
      expect_same(found(*cache, id), record);
    }
  }
  EXPECT_EQ(test::sql(file_, "SELECT count(*) FROM tiles"), "1");
  EXPECT_EQ(test::sql(file_, "SELECT count(*) FROM terrella_cache_tiles"), "1");
  EXPECT_EQ(test::sql(file_, "SELECT count(*) FROM terrella_cache_absences"), "0");
}

TEST_F(Cache, NoMissingTakesThePlaceOfATileWhichIsAskedForAgainAfterTheMissingLife) {
  const TileId id = nth_tile(4, 5);
  const auto cache = open_cache(file_);
  for (const MissingKind kind : {MissingKind::absent, MissingKind::blank, MissingKind::broken, MissingKind::failed}) {
    for (const bool flushed : {false, true}) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(kind) << flushed);
      CacheRecord expected = tile_record(id);
      cache->store(id, expected);
      if (flushed) {
        ASSERT_TRUE(cache->flush());
      }
      const CacheRecord missing = missing_record(kind, "gone", 5000);
      cache->store(id, missing);
      if (kind != MissingKind::failed) expected.expires_unix_s = missing.expires_unix_s;
      expect_same(found(*cache, id), expected);
      ASSERT_TRUE(cache->flush());
      expect_same(found(*cache, id), expected);
      EXPECT_EQ(test::sql(file_, "SELECT count(*) FROM terrella_cache_absences"), "0");
    }
  }
}

TEST_F(Cache, LevelsAreAddedAtBothEnds) {
  TileSetInfo middle = test::planet();
  middle.grid.min_level = 3;
  middle.grid.max_level = 5;
  const TileId id = nth_tile(4, 5);
  {
    const auto cache = TileCache::open(file_, middle, test::kSource);
    ASSERT_TRUE(cache) << cache.error().message;
    (*cache)->store(id, tile_record(id));
  }
  const auto cache = open_cache(file_);
  expect_same(found(*cache, id), tile_record(id));
  EXPECT_EQ(
      test::sql(file_, "SELECT group_concat(zoom_level) FROM (SELECT zoom_level FROM gpkg_tile_matrix ORDER BY 1)"),
      "0,1,2,3,4,5,6,7,8,9,10,11,12");
  EXPECT_TRUE(TileCache::open(file_, middle, test::kSource));
  auto source = open_tile_set(file_);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ((*source)->info().grid, test::planet().grid);
}

TEST_F(Cache, RenewsATileThatIsQueuedAndOneThatIsStored) {
  const TileId id = nth_tile(4, 5);
  const auto cache = open_cache(file_);
  CacheRecord expected = tile_record(id);
  cache->store(id, expected);
  for (const int time_s : {7000, 8000}) {
    cache->renew(id, time_s, time_s + 100);
    expected.stored_unix_s = time_s;
    expected.expires_unix_s = time_s + 100;
    expect_same(found(*cache, id), expected);
    ASSERT_TRUE(cache->flush());
    expect_same(found(*cache, id), expected);
  }
}

TEST_F(Cache, IsATileSetForUsAndForGdalWhileItIsInUseAndAfter) {
  auto cache = open_cache(file_);
  const TileId id = nth_tile(2, 3);
  cache->store(id, tile_record(id));
  ASSERT_TRUE(cache->flush());
  const std::string gdalinfo =
      std::string(TERRELLA_GDALINFO) + " '" + file_.string() + "' >" + (folder_ / "log").string() + " 2>&1";
  for (const bool in_use : {true, false}) {
    SCOPED_TRACE(in_use);
    auto source = open_tile_set(file_);
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ((*source)->info().name, "Planet");
    EXPECT_EQ((*source)->info().grid, test::planet().grid);
    auto tile = (*source)->read(id);
    ASSERT_TRUE(tile) << tile.error().why;
    EXPECT_EQ(tile->bytes, tile_record(id).bytes);
    EXPECT_EQ(std::system(gdalinfo.c_str()), 0);
    source->reset();  // a file that somebody reads keeps its log
    cache.reset();
  }
  EXPECT_FALSE(fs::exists(file_.string() + "-wal"));
  EXPECT_FALSE(fs::exists(file_.string() + "-shm"));
  EXPECT_EQ(test::sql(file_, "PRAGMA journal_mode"), "delete");
}

}  // namespace
}  // namespace terrella
