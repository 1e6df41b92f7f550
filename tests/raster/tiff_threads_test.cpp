#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "raster_files.h"

namespace terrella::test {
namespace {

constexpr int kThreadSide = 400;
constexpr int kThreads = 8;

/// Eight threads read all blocks in different orders, and get what one thread gets.
void expect_same_in_threads(const std::string& options) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Byte", kThreadSide, kThreadSide, 3,
            [](int x, int y, int band) { return std::floor(256.0 * noise_at(x, y, band)); });
  ASSERT_TRUE(translate(options, folder / "in.raw", folder / "in.tif"));
  const auto alone = open_raster(folder / "in.tif", some_place());
  ASSERT_TRUE(alone) << alone.error().message;
  const auto shared = open_raster(folder / "in.tif", some_place());
  ASSERT_TRUE(shared) << shared.error().message;
  const RasterLevel& level = (*alone)->info().levels.back();
  const auto columns = (level.width_px + level.block_width_px - 1) / level.block_width_px;
  const auto rows = (level.height_px + level.block_height_px - 1) / level.block_height_px;
  std::vector<Image> expected;
  for (std::int64_t i = 0; i < columns * rows; ++i) {
    expected.push_back(*(*alone)->read({.level = 0, .x = i % columns, .y = i / columns})->make_picture());
  }
  std::atomic<int> wrong{0};
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&, t] {
        for (std::int64_t k = 0; k < columns * rows; ++k) {
          const std::int64_t i = (k * (2 * t + 1) + t) % (columns * rows);
          auto tile = (*shared)->read({.level = 0, .x = i % columns, .y = i / columns});
          const auto image = tile ? tile->make_picture() : Result<Image, TileFailure>(tile.error());
          if (!image || image->rgba != expected[static_cast<std::size_t>(i)].rgba) ++wrong;
        }
      });
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST(TiffThreadsTest, Tiles) { expect_same_in_threads("-co TILED=YES -co BLOCKXSIZE=64 -co BLOCKYSIZE=64"); }
TEST(TiffThreadsTest, CompressedTiles) {
  expect_same_in_threads("-co TILED=YES -co BLOCKXSIZE=64 -co BLOCKYSIZE=64 -co COMPRESS=JPEG -co PHOTOMETRIC=YCBCR");
}
TEST(TiffThreadsTest, PlanesOfTiles) {
  expect_same_in_threads("-co TILED=YES -co BLOCKXSIZE=64 -co BLOCKYSIZE=64 -co INTERLEAVE=BAND -co COMPRESS=DEFLATE");
}
TEST(TiffThreadsTest, Strips) { expect_same_in_threads("-co COMPRESS=DEFLATE"); }

}  // namespace
}  // namespace terrella::test
