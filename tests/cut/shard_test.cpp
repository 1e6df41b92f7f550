#include <gtest/gtest.h>

#include "cut_files.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

class Shards : public testing::Test {
 protected:
  Shards() { write_png(folder_ / "in.png", noise(1024, 512)); }

  [[nodiscard]] CutOptions options(std::optional<CutShard> shard, bool join = false) const {
    return {.images = {folder_ / "in.png"},
            .output = folder_ / "out.gpkg",
            .tile_px = 16,
            .name = "n",
            .shard = shard,
            .join = join};
  }
  void expect_joined_is_whole() {
    ASSERT_TRUE(must_cut(options({}, true)));
    EXPECT_EQ(folder_.names(), (std::vector<std::string>{"in.png", "out.gpkg"})) << "shards are removed";
    CutOptions whole = options({});
    whole.output = folder_ / "whole.gpkg";
    ASSERT_TRUE(must_cut(whole));
    EXPECT_TRUE(read_bytes(folder_ / "out.gpkg") == read_bytes(folder_ / "whole.gpkg"));
  }

  ScratchFolder folder_;
};

TEST_F(Shards, JoinedAreTheSameBytesAsTheWhole) {
  std::int64_t tiles = 0;
  for (const int index : {3, 1, 2}) {
    const auto made = cut(options(CutShard{index, 3}));
    ASSERT_TRUE(made) << made.error().message;
    tiles += made->tiles;
  }
  EXPECT_EQ(tiles, 64 * 32 + 32 * 16 + 16 * 8 + 8 * 4) << "each tile of four levels once";
  expect_joined_is_whole();
}

TEST_F(Shards, AreKeptForAnotherJoin) {
  for (const int index : {1, 2}) ASSERT_TRUE(must_cut(options(CutShard{index, 2})));
  CutOptions keeping = options({}, true);
  keeping.keep_shards = true;
  ASSERT_TRUE(must_cut(keeping));
  const auto first = read_bytes(folder_ / "out.gpkg");
  ASSERT_TRUE(must_cut(keeping));
  EXPECT_TRUE(read_bytes(folder_ / "out.gpkg") == first);
  expect_joined_is_whole();
}

TEST_F(Shards, MayBeMoreThanThereIsWork) {
  for (int index = 1; index <= 7; ++index) ASSERT_TRUE(must_cut(options(CutShard{index, 7})));
  expect_joined_is_whole();
}

TEST_F(Shards, TiffsAndMosaicsJumpToTheirRows) {
  std::vector<fs::path> parts;
  const Image picture = noise(1024, 512);
  for (int i = 0; i < 4; ++i) {
    parts.push_back(folder_ / ("part" + std::to_string(i) + ".png"));
    write_png(parts.back(), part_of(picture, i % 2 * 512, i / 2 * 256, 512, 256));
  }
  CutOptions whole = options({});
  ASSERT_TRUE(must_cut(whole));
  const auto expected = all_tiles(folder_ / "out.gpkg");
  for (int index = 1; index <= 3; ++index) {
    CutOptions part = options(CutShard{index, 3});
    part.images = parts;
    part.mosaic = MosaicGrid{2, 2};
    part.force = true;
    ASSERT_TRUE(must_cut(part));
  }
  CutOptions join = options({}, true);
  join.images = parts;
  join.mosaic = MosaicGrid{2, 2};
  join.force = true;
  ASSERT_TRUE(must_cut(join));
  EXPECT_TRUE(all_tiles(folder_ / "out.gpkg") == expected);
}

TEST_F(Shards, MissingOnesAreNamed) {
  expect_refused(options({}, true), {"out.gpkg", "‹shard›"});
  ASSERT_TRUE(must_cut(options(CutShard{2, 4})));
  expect_refused(options({}, true), {"1, 3, 4 of 4"});
  EXPECT_FALSE(fs::exists(folder_ / "out.gpkg"));
}

TEST_F(Shards, OfOtherOptionsAreNotJoined) {
  for (const int index : {1, 2}) ASSERT_TRUE(must_cut(options(CutShard{index, 2})));
  CutOptions other = options({}, true);
  other.quality = 20;
  expect_refused(other, {"no shards"});
}

TEST_F(Shards, DoneOnesAreNotDoneAgain) {
  ASSERT_TRUE(must_cut(options(CutShard{1, 2})));
  CutOptions again = options(CutShard{1, 2});
  bool read = false;
  again.progress = [&](auto, auto) { return read = true; };
  ASSERT_TRUE(must_cut(again));
  EXPECT_FALSE(read);
}

TEST_F(Shards, NumbersOutOfRangeAreRefused) {
  for (const CutShard& shard : {CutShard{0, 2}, CutShard{3, 2}, CutShard{1, 0}})
    expect_refused(options(shard), {"shard"});
}

}  // namespace
}  // namespace terrella::test
