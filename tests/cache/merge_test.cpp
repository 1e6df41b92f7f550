#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <set>

#include "cache/cache_test_support.h"
#include "streaming/cache/cache_report.h"
#include "streaming/cache/merge_caches.h"
#include "streaming/sets/open_tile_set.h"
#include "streaming/tile_lister.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
using test::found;
using test::missing_record;
using test::nth_tile;
using test::open_cache;
using test::tile_record;

class Merge : public testing::Test {
 protected:
  void put(const fs::path& file, const TileId& id, const CacheRecord& record) const {
    const auto cache = open_cache(file);
    cache->store(id, record);
    ASSERT_TRUE(cache->flush());
  }
  [[nodiscard]] MergeSummary merge() const {
    const auto summary = merge_caches({a_, b_}, out_);
    EXPECT_TRUE(summary) << summary.error().message;
    return summary ? *summary : MergeSummary{};
  }
  [[nodiscard]] std::string refusal(const std::vector<fs::path>& caches) const {
    const auto summary = merge_caches(caches, out_);
    EXPECT_FALSE(summary);
    EXPECT_FALSE(fs::exists(out_));
    return summary ? "" : summary.error().message;
  }

  test::ScratchFolder folder_;
  const fs::path a_ = folder_ / "a.gpkg", b_ = folder_ / "b.gpkg", out_ = folder_ / "out.gpkg";
};

TEST_F(Merge, LosesNothing) {
  {
    const auto a = open_cache(a_);
    const auto b = open_cache(b_);
    for (int n = 0; n < 300; ++n) {
      (n % 3 == 0 ? a : b)->store(nth_tile(6, n), tile_record(nth_tile(6, n), 500, static_cast<unsigned>(n % 7)));
    }
  }
  put(a_, nth_tile(7, 1), missing_record(MissingKind::blank, "the sea"));
  put(b_, nth_tile(7, 2), missing_record(MissingKind::failed, "time-out"));
  const MergeSummary summary = merge();
  EXPECT_EQ(summary.tiles, 300);
  EXPECT_EQ(summary.missing, 2);
  EXPECT_EQ(summary.dropped, 0);
  EXPECT_EQ(test::integrity(out_), "ok");
  const auto merged = open_cache(out_);
  ASSERT_TRUE(merged->set_aside().empty());
  for (int n = 0; n < 300; ++n) {
    const auto got = found(*merged, nth_tile(6, n));
    const CacheRecord expected = tile_record(nth_tile(6, n), 500, static_cast<unsigned>(n % 7));
    ASSERT_TRUE(got);
    EXPECT_EQ(got->bytes, expected.bytes);
    EXPECT_EQ(got->etag, expected.etag);
    EXPECT_EQ(got->last_modified, expected.last_modified);
    EXPECT_EQ(got->stored_unix_s, expected.stored_unix_s);
    EXPECT_EQ(got->expires_unix_s, expected.expires_unix_s);
  }
  EXPECT_EQ(found(*merged, nth_tile(7, 1))->missing, MissingKind::blank);
  EXPECT_EQ(found(*merged, nth_tile(7, 1))->why, "the sea");
  EXPECT_EQ(found(*merged, nth_tile(7, 2))->missing, MissingKind::failed);
}

TEST_F(Merge, ATileOrElseTheNewestOfAPlaceWinsInEitherOrder) {
  struct Case {
    CacheRecord loser, winner;
  };
  const TileId id = nth_tile(6, 5);
  const Case cases[] = {
      {tile_record(id, 100, 1), tile_record(id, 200, 2)},
      {missing_record(MissingKind::absent, "", 1000), tile_record(id, 100, 1)},
      {missing_record(MissingKind::absent, "gone", 5000), tile_record(id, 100, 1)},
      {missing_record(MissingKind::blank, "", 1001), tile_record(id, 100, 1)},  // the same second: the tile
      {missing_record(MissingKind::failed, "", 9000), tile_record(id, 100, 1)},
      {missing_record(MissingKind::absent, "", 1000), missing_record(MissingKind::blank, "", 2000)},
  };
  for (const Case& one : cases) {
    for (const bool swapped : {false, true}) {
      put(a_, id, swapped ? one.winner : one.loser);
      put(b_, id, swapped ? one.loser : one.winner);
      EXPECT_EQ(merge().dropped, 1);
      const auto got = found(*open_cache(out_), id);
      ASSERT_TRUE(got);
      EXPECT_EQ(got->missing, one.winner.missing);
      EXPECT_EQ(got->bytes, one.winner.bytes);
      EXPECT_EQ(got->stored_unix_s, one.winner.stored_unix_s);
      for (const fs::path& file : {a_, b_, out_}) fs::remove(file);
    }
  }
}

TEST_F(Merge, OtherSourcesGridsAndFilesAreRefusedByName) {
  put(a_, nth_tile(6, 1), tile_record(nth_tile(6, 1)));
  static_cast<void>(TileCache::open(b_, test::planet(), "https://other.example/{z}"));
  EXPECT_NE(refusal({a_, b_}).find("https://other.example/{z}"), std::string::npos);
  EXPECT_NE(refusal({a_, b_}).find(b_.string()), std::string::npos);
  TileSetInfo finer = test::planet();
  finer.grid.tile_px = 512;
  fs::remove(b_);
  static_cast<void>(TileCache::open(b_, finer, test::kSource));
  EXPECT_NE(refusal({a_, b_}).find("grid"), std::string::npos);
  std::ofstream(folder_ / "text") << "text";
  EXPECT_NE(refusal({a_, folder_ / "text"}).find("not a cache"), std::string::npos);
  EXPECT_NE(refusal({folder_ / "nothing"}).find("no such file"), std::string::npos);
}

TEST_F(Merge, ACacheThatWasCutOffIsCalledDamaged) {
  {
    const auto cache = open_cache(a_);
    for (int n = 0; n < 300; ++n) cache->store(nth_tile(6, n), tile_record(nth_tile(6, n)));
  }
  const std::uintmax_t whole = fs::file_size(a_);
  for (const std::uintmax_t size : {whole * 9 / 10, whole / 2, std::uintmax_t{8192}, std::uintmax_t{5000},
                                    std::uintmax_t{3000}, std::uintmax_t{100}}) {
    fs::resize_file(a_, size);
    EXPECT_NE(refusal({a_}).find(a_.string() + ": the cache is damaged or was cut off"), std::string::npos)
        << size << ": " << refusal({a_});
  }
  fs::resize_file(a_, 0);
  EXPECT_NE(refusal({a_}).find("is empty"), std::string::npos);
}

TEST_F(Merge, WhatIsPinnedInOneIsPinnedInTheResult) {
  const TileId id = nth_tile(6, 5);
  CacheRecord pinned = tile_record(id, 100, 1);
  pinned.pinned = true;
  for (const bool swapped : {false, true}) {
    put(swapped ? b_ : a_, id, pinned);
    put(swapped ? a_ : b_, id, tile_record(id, 200, 2));
    EXPECT_EQ(merge().tiles, 1);
    const auto got = found(*open_cache(out_), id);
    ASSERT_TRUE(got);
    EXPECT_TRUE(got->pinned);
    EXPECT_EQ(got->bytes.size(), 200U);
    for (const fs::path& file : {a_, b_, out_}) fs::remove(file);
  }
}

TEST_F(Merge, AnOutputThatIsThereIsReplacedOnlyIfItIsOneOfTheCaches) {
  put(a_, nth_tile(6, 1), tile_record(nth_tile(6, 1)));
  put(b_, nth_tile(6, 2), tile_record(nth_tile(6, 2)));
  EXPECT_FALSE(merge_caches({a_}, b_));
  const auto into = merge_caches({a_, b_}, b_);
  ASSERT_TRUE(into) << into.error().message;
  EXPECT_EQ(into->tiles, 2);
  EXPECT_TRUE(found(*open_cache(b_), nth_tile(6, 1)));
}

TEST_F(Merge, InterruptedItLeavesNothingAndCanBeRunAgain) {
  {
    const auto cache = open_cache(a_);
    for (int n = 0; n < 2000; ++n) cache->store(nth_tile(8, n), tile_record(nth_tile(8, n), 100));
  }
  // SQLite leaves its journal where it cannot roll back, as on a disk that takes no byte any more.
  const auto leave_a_journal = [&](std::int64_t, std::int64_t) {
    std::vector<fs::path> parts;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      if (entry.path().extension() == ".part") parts.push_back(entry.path());
    }
    EXPECT_EQ(parts.size(), 1U);
    for (const fs::path& part : parts) std::ofstream(part.string() + "-journal") << "journal";
    return false;
  };
  EXPECT_FALSE(merge_caches({a_}, out_, leave_a_journal));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1);
  const auto again = merge_caches({a_}, out_);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->tiles, 2000);
}

TEST_F(Merge, AFileThatTookTheNameMeanwhileStays) {
  {
    const auto cache = open_cache(a_);
    for (int n = 0; n < 600; ++n) cache->store(nth_tile(8, n), tile_record(nth_tile(8, n), 100));
  }
  const auto take_the_name = [&](std::int64_t, std::int64_t) {
    std::ofstream(out_) << "of another program";
    return true;
  };
  const auto merged = merge_caches({a_}, out_, take_the_name);
  ASSERT_FALSE(merged);
  EXPECT_NE(merged.error().message.find("out.gpkg: is there already"), std::string::npos) << merged.error().message;
  EXPECT_EQ(fs::file_size(out_), 18U);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 2);
}

TEST_F(Merge, APartThatIsRemovedMeanwhileIsNoSuccess) {
  {
    const auto cache = open_cache(a_);
    for (int n = 0; n < 600; ++n) cache->store(nth_tile(8, n), tile_record(nth_tile(8, n), 100));
  }
  const auto remove_parts = [&](std::int64_t, std::int64_t) {
    std::vector<fs::path> parts;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      if (entry.path().extension() == ".part") parts.push_back(entry.path());
    }
    for (const fs::path& part : parts) fs::remove(part);
    return true;
  };
  const auto merged = merge_caches({a_}, out_, remove_parts);
  ASSERT_FALSE(merged);
  EXPECT_NE(merged.error().message.find("out.gpkg"), std::string::npos) << merged.error().message;
  EXPECT_FALSE(fs::exists(out_));
}

/// Merges in a process of its own that is killed -9 after its first rows.
void merge_and_be_killed(const fs::path& cache, const fs::path& output) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    static_cast<void>(merge_caches({cache}, output, [](std::int64_t, std::int64_t) { return raise(SIGKILL) == 0; }));
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
}

TEST_F(Merge, WhatAKilledMergeLeftGoesWithTheNextIntoThatName) {
  {
    const auto cache = open_cache(a_);
    for (int n = 0; n < 1000; ++n) cache->store(nth_tile(8, n), tile_record(nth_tile(8, n), 100));
  }
  merge_and_be_killed(a_, out_);
  const auto names = [&] {
    std::set<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder_.path())) found.insert(entry.path().filename().string());
    return found;
  };
  ASSERT_GE(names().size(), 2U);  // the part, and the journal that SQLite may have at that moment
  const std::string left = *names().begin();
  ASSERT_TRUE(left.starts_with(".out.gpkg.") && left.ends_with(".part")) << left;
  // Names of a process that lives, of another machine, of another output, and two that no merge makes.
  const std::string host = left.substr(10, left.rfind('.', left.size() - 6) - 10);
  const std::string dead = left.substr(left.rfind('.', left.size() - 6) + 1);
  std::set<std::string> kept{"a.gpkg",
                             ".out.gpkg." + host + "." + std::to_string(getppid()) + ".part",
                             ".out.gpkg.not-" + host + "." + dead,
                             ".other.gpkg." + host + "." + dead,
                             ".out.gpkg." + host + ".0.part",
                             ".out.gpkg." + host + ".12x.part"};
  for (const std::string& name : kept) std::ofstream(folder_ / name, std::ios::app);
  for (const bool with_part : {false, true}) {
    if (!with_part) fs::remove(folder_ / left);
    std::ofstream(folder_ / (left + "-journal"));
    ASSERT_TRUE(merge_caches({a_}, out_));
    EXPECT_FALSE(fs::exists(folder_ / (left + "-journal"))) << with_part;
    fs::remove(out_);
    std::ofstream(folder_ / left);
  }
  const auto again = merge_caches({a_}, out_);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->tiles, 1000);
  kept.insert("out.gpkg");
  EXPECT_EQ(names(), kept);
}

TEST_F(Merge, ReportsCountAndFindDamage) {
  {
    const auto cache = open_cache(a_);
    for (int n = 0; n < 200; ++n) cache->store(nth_tile(8, n), tile_record(nth_tile(8, n), 3000, n % 2));
    cache->store(nth_tile(9, 0), missing_record(MissingKind::absent, "", 1000));
    cache->store(nth_tile(9, 1), missing_record(MissingKind::absent, "", 5000));
    cache->store(nth_tile(9, 2), missing_record(MissingKind::broken, "", 5000));
    ASSERT_TRUE(cache->flush());
    const auto report = verify_cache(a_, 2000);  // in use
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->source_key, test::kSource);
    EXPECT_EQ(report->tiles, 200);
    EXPECT_EQ(report->expired_tiles, 100);
    EXPECT_EQ(report->missing, (std::array<std::int64_t, 4>{2, 0, 1, 0}));
    EXPECT_EQ(report->expired_missing, (std::array<std::int64_t, 4>{1, 0, 0, 0}));
    EXPECT_TRUE(report->problems->empty());
  }
  int listed = 0;
  const auto tiles = open_tile_set(a_);
  ASSERT_TRUE(tiles) << tiles.error().message;
  auto* lister = dynamic_cast<TileLister*>(tiles->get());
  ASSERT_NE(lister, nullptr);
  ASSERT_TRUE(lister->for_each_tile([&](const TileId& id) { return id.level == 8 && ++listed < 150; }));
  EXPECT_EQ(listed, 150);
  std::fstream file(a_, std::ios::binary | std::ios::in | std::ios::out);
  file.seekp(static_cast<std::streamoff>(fs::file_size(a_) / 4096 * 3 / 4 * 4096));
  file << std::string(8 * 4096, static_cast<char>(0xa5));
  file.close();
  const auto damaged = verify_cache(a_, 2000);
  EXPECT_TRUE(!damaged || !damaged->problems->empty());
  EXPECT_FALSE(read_cache_report(folder_ / "none", 0));
}

}  // namespace
}  // namespace terrella
