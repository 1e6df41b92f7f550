#include "streaming/pmtiles/pmtiles_index.h"

#include <gtest/gtest.h>

namespace terrella {
namespace {

constexpr ByteRange kLeaves{.offset = 1000, .length = 500};
constexpr ByteRange kTiles{.offset = 5000, .length = 10000};

PmtilesHeader header() {
  PmtilesHeader header;
  header.leaves = kLeaves;
  header.tiles = kTiles;
  header.max_level = 3;
  return header;
}

std::vector<std::byte> leaf_of_tile_9() {
  std::vector<std::byte> bytes;
  for (const int value : {1, 9, 2, 50, 11}) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

TEST(PmtilesIndexTest, NamesTheBytesToReadNext) {
  PmtilesIndex index(
      header(), {{.tile = 0, .offset = 100, .length = 7, .run = 2}, {.tile = 9, .offset = 20, .length = 5, .run = 0}});
  const auto tile = index.next(1);
  ASSERT_TRUE(tile);
  EXPECT_TRUE(tile->is_tile);
  EXPECT_EQ(tile->range, (ByteRange{5100, 7}));
  EXPECT_EQ(index.next(2).error().kind, MissingKind::absent);
  const auto leaf = index.next(10);
  ASSERT_TRUE(leaf);
  EXPECT_FALSE(leaf->is_tile);
  EXPECT_EQ(leaf->range, (ByteRange{1020, 5}));
  ASSERT_TRUE(index.learn(leaf->range, leaf_of_tile_9()));
  const auto found = index.next(10);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->range, (ByteRange{5010, 50}));
  EXPECT_EQ(index.next(11).error().kind, MissingKind::absent);
}

TEST(PmtilesIndexTest, NothingIsKeptOfADamagedLeaf) {
  PmtilesIndex index(header(), {{.tile = 9, .offset = 20, .length = 5, .run = 0}});
  const Status learned = index.learn({1020, 5}, {});
  ASSERT_FALSE(learned);
  EXPECT_NE(learned.error().message.find("damaged"), std::string::npos);
  const auto again = index.next(9);
  ASSERT_TRUE(again);
  EXPECT_FALSE(again->is_tile);
  ASSERT_TRUE(index.learn(again->range, leaf_of_tile_9()));
  EXPECT_TRUE(index.next(9)->is_tile);
}

TEST(PmtilesIndexTest, NothingBeyondItsSectionIsRead) {
  PmtilesIndex index(header(), {{.tile = 0, .offset = 9990, .length = 11, .run = 1},
                                {.tile = 1, .offset = 9990, .length = 10, .run = 1},
                                {.tile = 2, .offset = std::uint64_t{1} << 62, .length = 1, .run = 1},
                                {.tile = 3, .offset = 496, .length = 5, .run = 0}});
  EXPECT_EQ(index.next(0).error().kind, MissingKind::broken);
  EXPECT_TRUE(index.next(1));
  EXPECT_EQ(index.next(2).error().kind, MissingKind::broken);
  EXPECT_EQ(index.next(3).error().kind, MissingKind::broken);
}

}  // namespace
}  // namespace terrella
