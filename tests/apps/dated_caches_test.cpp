// The files of several times beside a cache, opened as one set without a server.
#include "apps/open_scene/dated_caches.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "base/iso_time.h"
#include "streaming/cache/tile_cache.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

UtcTime at(const char* text) { return read_named_time(text).value().from; }

class DatedCachesTest : public testing::Test {
 protected:
  DatedCachesTest() : folder_(fs::temp_directory_path() / ("dated_caches_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~DatedCachesTest() override { fs::remove_all(folder_); }
  void add(const std::string& name) {
    TileSetInfo info;
    info.name = "Planet";
    info.grid.max_level = 1;
    EXPECT_TRUE(TileCache::open(folder_ / name, info, "source of the test"));
  }

  fs::path folder_;
};

TEST_F(DatedCachesTest, AreStepsOfOneSet) {
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

TEST_F(DatedCachesTest, NoFilesAreNoSet) {
  const auto none = open_dated_caches(folder_ / "a.gpkg", "");
  ASSERT_TRUE(none);
  EXPECT_EQ(*none, nullptr);
}

}  // namespace
}  // namespace terrella
