// Files of several times, found by a pattern or beside a cache and opened as one set.
#include "apps/open_scene/dated_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/iso_time.h"
#include "streaming/cache/tile_cache.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

UtcTime at(const char* text) { return read_named_time(text).value().from; }

class DatedFilesTest : public testing::Test {
 protected:
  DatedFilesTest() : folder_(fs::temp_directory_path() / ("dated_caches_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~DatedFilesTest() override { fs::remove_all(folder_); }
  void add(const std::string& name) {
    TileSetInfo info;
    info.name = "Planet";
    info.grid.max_level = 1;
    EXPECT_TRUE(TileCache::open(folder_ / name, info, "source of the test"));
  }

  fs::path folder_;
};

TEST_F(DatedFilesTest, AreStepsOfOneSet) {
  for (const char* name : {"a.2026-06-01.gpkg", "a.2026-06-02T06-30Z.gpkg", "a.2026-06-04.gpkg", "a.old.gpkg",
                           "a.2026-06-09.tif", "b.2026-06-09.gpkg"}) {
    add(name);
  }
  const auto newest = open_dated_caches(folder_ / "a.gpkg", "");
  ASSERT_TRUE(newest && *newest) << newest.error().message;
  EXPECT_EQ((*newest)->info().time, "2026-06-04");
  ASSERT_TRUE((*newest)->info().steps);
  EXPECT_EQ((*newest)->info().steps->count(), 3);
  const auto other = (*newest)->at_time(at("2026-06-03"));
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_EQ((*other)->info().time, "2026-06-02T06:30Z");
  EXPECT_EQ((*other)->info().instant, at("2026-06-02T06:30Z"));
  EXPECT_EQ((*open_dated_caches(folder_ / "a.gpkg", "2026-06-01T12:00Z"))->info().time, "2026-06-01");
  const auto early = open_dated_caches(folder_ / "a.gpkg", "2026-05-31");
  ASSERT_FALSE(early);
  EXPECT_NE(early.error().message.find("the first time is 2026-06-01"), std::string::npos) << early.error().message;
}

TEST_F(DatedFilesTest, NoFilesAreNoSet) {
  const auto none = open_dated_caches(folder_ / "a.gpkg", "");
  ASSERT_TRUE(none);
  EXPECT_EQ(*none, nullptr);
}

/// Times of the files that fit a pattern, in the order of time.
std::vector<std::string> times_of(const fs::path& pattern) {
  const auto files = find_dated_files(pattern);
  EXPECT_TRUE(files) << files.error().message;
  std::vector<std::string> times;
  for (const DatedFile& file : *files) times.push_back(file.time);
  std::ranges::sort(times);
  return times;
}

TEST_F(DatedFilesTest, AreFoundByTheirNames) {
  for (const char* name : {"ice_20260601_v2.tif", "ice_20260701_v2.tif", "ice_20261301_v2.tif", "ice_20260701_v3.tif",
                           "ice_20260701_v2.tif.aux.xml", "100%_2026152.tif", "snow_2026-06.tif", "snow_2026-06-02.tif",
                           "snow_2026-06-02T18-30.tif", "snow_last.tif", "Jun 2026.tif"}) {
    std::ofstream(folder_ / name) << "a picture";
  }
  using Times = std::vector<std::string>;
  EXPECT_EQ(times_of(folder_ / "ice_{time:%Y%m%d}_v2.tif"), (Times{"2026-06-01", "2026-07-01"}));
  EXPECT_EQ(times_of(folder_ / "100%_{time:%Y%j}.tif"), Times{"2026-06-01"});
  EXPECT_EQ(times_of(folder_ / "snow_{time}.tif"), (Times{"2026-06", "2026-06-02", "2026-06-02T18:30"}));
  EXPECT_EQ(times_of(folder_ / "{time:%b %Y}.tif"), Times{"2026-06"});
  EXPECT_EQ(times_of(folder_ / "{time:%b} {time:%Y}.tif"), Times{"2026-06"});
  EXPECT_EQ(times_of(folder_ / "none_{time}.tif"), Times{});
  const auto unknown = find_dated_files(folder_ / "ice_{time:%Q}.tif");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("%Q"), std::string::npos) << unknown.error().message;
  EXPECT_FALSE(find_dated_files(folder_ / "no folder" / "{time}.tif"));
}

TEST_F(DatedFilesTest, TwoOfOneInstantAreRefused) {
  const auto two = open_dated_files("x", {{"2026-06", "a"}, {"2026-06-01", "b"}}, "", {});
  ASSERT_FALSE(two);
  EXPECT_NE(two.error().message.find("b and a are of one time"), std::string::npos) << two.error().message;
}

}  // namespace
}  // namespace terrella
