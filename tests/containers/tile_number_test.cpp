#include "streaming/pmtiles/tile_number.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace terrella {
namespace {

TEST(TileNumberTest, FirstNumbersAreThoseOfTheSpecification) {
  EXPECT_EQ(tile_number({0, 0, 0}), 0U);
  EXPECT_EQ(tile_number({1, 0, 0}), 1U);
  EXPECT_EQ(tile_number({1, 0, 1}), 2U);
  EXPECT_EQ(tile_number({1, 1, 1}), 3U);
  EXPECT_EQ(tile_number({1, 1, 0}), 4U);
  EXPECT_EQ(tile_number({2, 0, 0}), 5U);
}

/// A Hilbert curve visits every tile of a level once, and each is beside the one before.
TEST(TileNumberTest, EachLevelIsOneCurve) {
  for (int level = 0; level <= 6; ++level) {
    TileId before = tile_of_number(first_number(level));
    for (std::uint64_t number = first_number(level); number < first_number(level + 1); ++number) {
      const TileId id = tile_of_number(number);
      ASSERT_EQ(id.level, level);
      ASSERT_EQ(tile_number(id), number);
      const std::int64_t step = std::abs(id.x - before.x) + std::abs(id.y - before.y);
      ASSERT_EQ(step, number == first_number(level) ? 0 : 1) << number;
      before = id;
    }
  }
}

TEST(TileNumberTest, CornersOfTheFinestLevelComeBack) {
  const std::int64_t last = (std::int64_t{1} << kMaxTileLevel) - 1;
  for (const auto& [x, y] : {std::pair<std::int64_t, std::int64_t>{0, 0}, {last, 0}, {0, last}, {last, last}}) {
    const TileId id{kMaxTileLevel, x, y};
    EXPECT_EQ(tile_of_number(tile_number(id)), id);
  }
}

}  // namespace
}  // namespace terrella
