#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "raster_files.h"
#include "streaming/cut/input/picture_raster.h"
#include "streaming/cut/input/row_reader.h"
#include "streaming/raster/rows/block_store.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

/// A picture of formulas, larger than what a store holds in memory if `large`.
StoredPixels size_of(bool large, std::size_t pixel_bytes) {
  return {.width_px = large ? 6001 : 601, .height_px = large ? 7503 : 403, .pixel_bytes = pixel_bytes};
}

std::uint8_t formula(std::int64_t x, std::int64_t y, std::int64_t c) {
  return static_cast<std::uint8_t>(x * 7 + y * 13 + c * 31 + (x * y) / 5);
}

class Stores : public testing::TestWithParam<std::tuple<bool, std::size_t>> {};

TEST_P(Stores, GiveBlocksInAnyOrderAndLeaveNothing) {
  const std::size_t pixel_bytes = std::get<1>(GetParam());
  const StoredPixels pixels = size_of(std::get<0>(GetParam()), pixel_bytes);
  const ScratchFolder folder;
  std::int64_t rows_read = 0;
  BlockStore store(pixels, folder.path(), [&](std::span<std::uint8_t> row) -> Status {
    for (std::int64_t x = 0; x < pixels.width_px; ++x) {
      for (std::int64_t c = 0; c < 4; ++c) {
        row[static_cast<std::size_t>(4 * x + c)] = c == 3 && pixel_bytes == 3 ? 255 : formula(x, rows_read, c);
      }
    }
    ++rows_read;
    return Done{};
  });
  const std::int64_t columns = (pixels.width_px + store.block_width_px() - 1) / store.block_width_px();
  const std::int64_t rows = (pixels.height_px + store.block_height_px() - 1) / store.block_height_px();
  ASSERT_TRUE(store.read(0, 0));
  EXPECT_EQ(rows_read, store.block_height_px());
  for (const auto& [column, row] : {std::pair{columns - 1, rows - 1}, std::pair{std::int64_t{0}, std::int64_t{0}},
                                    std::pair{columns / 2, rows / 2}}) {
    const auto block = store.read(column, row);
    ASSERT_TRUE(block) << block.error().message;
    for (std::int64_t v = 0; v < store.block_height_px(); ++v) {
      for (std::int64_t u = 0; u < store.block_width_px(); ++u) {
        const std::int64_t x = column * store.block_width_px() + u;
        const std::int64_t y = row * store.block_height_px() + v;
        if (x >= pixels.width_px || y >= pixels.height_px) continue;
        const std::uint8_t* pixel = block->data() + 4 * (v * store.block_width_px() + u);
        for (std::int64_t c = 0; c < 3; ++c) ASSERT_EQ(pixel[c], formula(x, y, c)) << x << " " << y;
        ASSERT_EQ(pixel[3], pixel_bytes == 3 ? 255 : formula(x, y, 3));
      }
    }
  }
  EXPECT_EQ(rows_read, pixels.height_px);
  EXPECT_TRUE(folder.names().empty());
}

INSTANTIATE_TEST_SUITE_P(Sizes, Stores,
                         testing::Combine(testing::Bool(), testing::Values(std::size_t{3}, std::size_t{4})));

TEST(RowsRasterTest, ErrorsOfRowsAndFoldersAreNamed) {
  const StoredPixels small = size_of(false, 4);
  BlockStore damaged(small, "/nowhere", [row = 0](std::span<std::uint8_t>) mutable -> Status {
    if (++row > 300) return Error{"a.png: row 300 is bad"};
    return Done{};
  });
  EXPECT_TRUE(damaged.read(0, 0));
  for (int i = 0; i < 2; ++i) {
    const auto block = damaged.read(0, 1);
    ASSERT_FALSE(block);
    EXPECT_EQ(block.error().message, "a.png: row 300 is bad");
  }
  EXPECT_TRUE(damaged.read(1, 0));
  BlockStore homeless(size_of(true, 4), "/nowhere", [](std::span<std::uint8_t>) -> Status { return Done{}; });
  const auto block = homeless.read(0, 0);
  ASSERT_FALSE(block);
  EXPECT_NE(block.error().message.find("/nowhere"), std::string::npos) << block.error().message;
}

/// A picture without blocks of its own has the pixels that its rows have.
TEST(RowsRasterTest, PicturesOfEveryFormatHaveTheirRows) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Byte", 700, 300, 4,
            [](int x, int y, int band) { return std::floor(256.0 * noise_at(x / 9, y / 9, band)); });
  for (const auto& [name, options] :
       {std::pair{"a.png", "-of PNG"}, std::pair{"b.jpg", "-of JPEG -b 1 -b 2 -b 3"}, std::pair{"c.webp", "-of WEBP"},
        std::pair{"d.tif", "-co COMPRESS=LZW"}, std::pair{"e.png", "-of PNG -b 1"}}) {
    ASSERT_TRUE(translate(options, folder / "in.raw", folder / name)) << name;
    const auto source = open_picture_raster(folder / name, some_place());
    ASSERT_TRUE(source) << source.error().message;
    auto rows = open_rows(folder / name);
    ASSERT_TRUE(rows) << rows.error().message;
    EXPECT_EQ((*source)->info().opaque, !(*rows)->info().has_alpha) << name;
    const Image got = whole_picture(**source, 0);
    std::vector<std::uint8_t> row(static_cast<std::size_t>(got.width_px) * 4);
    for (int y = 0; y < got.height_px; ++y) {
      ASSERT_TRUE((*rows)->read_row(row));
      ASSERT_EQ(std::memcmp(row.data(), got.rgba.data() + static_cast<std::size_t>(y) * row.size(), row.size()), 0)
          << name << " row " << y;
    }
  }
}

TEST(RowsRasterTest, HeightsOfPng) {
  const ScratchFolder folder;
  const auto height = [](int x, int y, int) { return std::floor(60000.0 * noise_at(x, y, 0)); };
  write_raw(folder / "in.raw", "UInt16", 300, 150, 1, height);
  ASSERT_TRUE(translate("-of PNG", folder / "in.raw", folder / "in.png"));
  const auto source = open_picture_raster(folder / "in.png", some_place(),
                                          {.heights = true, .nodata = height(3, 0, 0), .scale = 0.5, .offset = -100.0});
  ASSERT_TRUE(source) << source.error().message;
  const Numbers got = whole_numbers(**source, 0);
  for (int i = 0; i < 300 * 150; ++i) {
    const double value = height(i % 300, i / 300, 0);
    if (value == height(3, 0, 0)) continue;
    ASSERT_EQ(got.values[static_cast<std::size_t>(i)], static_cast<float>(value * 0.5 - 100.0));
  }
  EXPECT_TRUE(std::isnan(got.values[3]));
}

}  // namespace
}  // namespace terrella::test
