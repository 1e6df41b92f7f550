#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "cache/cache_test_support.h"
#include "streaming/cache/cache_database.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
using test::nth_tile;
using test::open_cache;
using test::planet;
using test::tile_record;

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_text(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

class CacheDamage : public testing::Test {
 protected:
  void fill(int tiles) {
    const auto cache = open_cache(file_);
    for (int n = 0; n < tiles; ++n) cache->store(nth_tile(7, n), tile_record(nth_tile(7, n)));
    ASSERT_TRUE(cache->flush());
  }
  /// The file is renamed as it is, and a new cache works.
  void expect_set_aside(int number = 1) {
    const std::string before = contents(file_);
    const auto cache = open_cache(file_);
    ASSERT_TRUE(cache);
    ASSERT_EQ(cache->set_aside(), file_.string() + ".damaged-" + std::to_string(number));
    EXPECT_TRUE(contents(cache->set_aside()) == before);
    cache->store(nth_tile(7, 1), tile_record(nth_tile(7, 1)));
    EXPECT_TRUE(cache->flush());
  }
  std::string refusal(const std::string& source = test::kSource, const TileSetInfo& info = planet()) {
    const std::string before = contents(file_);
    const auto cache = TileCache::open(file_, info, source);
    EXPECT_FALSE(cache);
    EXPECT_TRUE(contents(file_) == before);
    return cache ? "" : cache.error().message;
  }

  test::ScratchFolder folder_;
  const fs::path file_ = folder_ / "planet.gpkg";
};

TEST_F(CacheDamage, WhatIsNoDatabaseIsSetAsideEachUnderANameOfItsOwn) {
  for (int n = 1; n <= 3; ++n) {
    write_text(file_, "not a database " + std::to_string(n));
    expect_set_aside(n);
  }
  EXPECT_EQ(contents(file_.string() + ".damaged-1"), "not a database 1");
}

TEST_F(CacheDamage, ATruncatedFile) {
  fill(300);
  fs::resize_file(file_, fs::file_size(file_) / 2);
  expect_set_aside();
}

TEST_F(CacheDamage, AnEmptyFileAndATruncatedHead) {
  write_text(file_, "");
  expect_set_aside(1);
  fs::resize_file(file_, 50);
  expect_set_aside(2);
}

TEST_F(CacheDamage, PagesOfNoise) {
  fill(300);
  std::fstream file(file_, std::ios::binary | std::ios::in | std::ios::out);
  for (int page = 4; page < 60; ++page) {
    file.seekp(page * 4096);
    file << std::string(4096, static_cast<char>(0xa5));
  }
  file.close();
  expect_set_aside();
}

TEST_F(CacheDamage, HostileSchemas) {
  const char* statements[] = {
      "CREATE TRIGGER t AFTER INSERT ON tiles BEGIN DELETE FROM tiles; END",
      "CREATE INDEX i ON tiles (abs(zoom_level))",
      "DROP TABLE terrella_cache_tiles",
      "DROP TABLE terrella_cache_tiles; CREATE VIEW terrella_cache_tiles AS SELECT 1 AS id",
      "ALTER TABLE tiles ADD COLUMN more AS (hex(zeroblob(1000000)))",
  };
  int number = 0;
  for (const char* statement : statements) {
    SCOPED_TRACE(statement);
    fill(1);
    test::sql(file_, statement);
    expect_set_aside(++number);
  }
}

TEST_F(CacheDamage, TheLogGoesWithTheFile) {
  fill(10);
  const auto cache = open_cache(file_);
  cache->store(nth_tile(7, 5), tile_record(nth_tile(7, 5), 9000, 2));
  ASSERT_TRUE(cache->flush());
  // As after a sudden end, with a file that was damaged besides.
  const fs::path copy = folder_ / "copy.gpkg";
  fs::copy_file(file_, copy);
  fs::copy_file(file_.string() + "-wal", copy.string() + "-wal");
  write_text(copy, "noise");
  const std::string log = contents(copy.string() + "-wal");
  const auto fresh = open_cache(copy);
  ASSERT_TRUE(fresh);
  EXPECT_TRUE(contents(fresh->set_aside().string() + "-wal") == log);
}

TEST_F(CacheDamage, AnotherSourcesCacheIsRefusedByName) {
  fill(3);
  const std::string other = refusal("https://other.example/{z}/{x}/{y}.png");
  EXPECT_NE(other.find(file_.string()), std::string::npos) << other;
  EXPECT_NE(other.find(test::kSource), std::string::npos) << other;
  EXPECT_NE(other.find("name another file"), std::string::npos) << other;
  TileSetInfo finer = planet();
  finer.grid.tile_px = 512;
  EXPECT_NE(refusal(test::kSource, finer).find("grid"), std::string::npos);
}

TEST_F(CacheDamage, ANewNameOrAttributionIsTheSameSource) {
  fill(3);
  TileSetInfo renamed = planet();
  renamed.attribution = "Somebody else";
  EXPECT_TRUE(TileCache::open(file_, renamed, test::kSource));
}

TEST(CacheSource, NamesOfMoreLevelsAreTheSameSource) {
  const std::string coarse = R"({"url":"https://t.example/{z}","levels":["a","b"],"shifts":[[1,0,4],[2,0,8]]})";
  const std::string fine =
      R"({"url":"https://t.example/{z}","levels":["a","b","c"],"shifts":[[1,0,4],[2,0,8],[4,0,16]]})";
  const std::string others[] = {
      R"({"url":"https://t.example/{z}","levels":["a","x","c"],"shifts":[[1,0,4],[2,0,8],[4,0,16]]})",
      R"({"url":"https://t.example/{z}","levels":["a","b"],"shifts":[]})",
      R"({"url":"https://u.example/{z}","levels":["a","b"],"shifts":[[1,0,4],[2,0,8]]})", "file:/a", ""};
  EXPECT_TRUE(same_source(coarse, fine));
  EXPECT_TRUE(same_source(fine, coarse));
  EXPECT_TRUE(same_source("file:/a", "file:/a"));
  for (const std::string& other : others) {
    EXPECT_FALSE(same_source(coarse, other)) << other;
    EXPECT_FALSE(same_source(other, fine)) << other;
  }
}

TEST_F(CacheDamage, ForeignFilesAreRefusedAndLeftAlone) {
  test::sql(file_, "CREATE TABLE gpkg_contents (table_name TEXT)");
  EXPECT_NE(refusal().find("is a tile set, not a cache"), std::string::npos);
  fs::remove(file_);
  test::sql(file_, "CREATE TABLE recipes (name TEXT)");
  EXPECT_NE(refusal().find("not a cache"), std::string::npos);
  fs::remove(file_);
  fill(1);
  test::sql(file_, "UPDATE terrella_cache SET value = '2' WHERE key = 'version'");
  EXPECT_NE(refusal().find("later version"), std::string::npos);
  EXPECT_FALSE(fs::exists(file_.string() + ".damaged-1"));
}

TEST_F(CacheDamage, AFolderAndAPlaceThatCannotBeWritten) {
  EXPECT_FALSE(TileCache::open(folder_.path(), planet(), test::kSource));
  write_text(folder_ / "file", "");
  const auto cache = TileCache::open(folder_ / "file/planet.gpkg", planet(), test::kSource);
  ASSERT_FALSE(cache);
  EXPECT_NE(cache.error().message.find("planet.gpkg"), std::string::npos) << cache.error().message;
}

}  // namespace
}  // namespace terrella
