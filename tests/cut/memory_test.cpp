#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <tiffio.h>
#include <unistd.h>

#include <algorithm>
#include <optional>

#include "picture_files.h"
#include "streaming/cut.h"
#include "streaming/cut/input/row_reader.h"
#include "streaming/cut/strip.h"

namespace terrella::test {
namespace {

TIFF* open_rgb_tiff(const std::filesystem::path& path, const char* mode, int width_px, int height_px) {
  TIFF* tiff = TIFFOpen(path.c_str(), mode);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width_px);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height_px);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 3);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_PACKBITS);
  return tiff;
}

/// Rows of one colour each: quick to write and small on the disk, whatever the height.
void write_tall_tiff(const std::filesystem::path& path, int width_px, int height_px) {
  TIFF* tiff = open_rgb_tiff(path, "w", width_px, height_px);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 64);
  for (int y = 0; y < height_px; ++y) {
    std::vector<std::uint8_t> row(static_cast<std::size_t>(width_px) * 3, static_cast<std::uint8_t>(y));
    TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(y), 0);
  }
  TIFFClose(tiff);
}

/// Value of the pixels in a row of a tile or strip of write_wide_bigtiff().
std::uint8_t value_of(std::uint32_t block, std::size_t row) {
  return static_cast<std::uint8_t>(std::size_t{block} * 31 + row * 7);
}

/// Each row of each tile of one colour; 0 px: strips of a row.
void write_wide_bigtiff(const std::filesystem::path& path, int width_px, int height_px, int tile_px) {
  TIFF* tiff = open_rgb_tiff(path, "w8", width_px, height_px);
  const auto side = static_cast<std::size_t>(tile_px);
  const std::size_t block_bytes = 3 * (tile_px > 0 ? side * side : static_cast<std::size_t>(width_px));
  std::vector<std::uint8_t> block(block_bytes);
  if (tile_px == 0) TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 1);
  if (tile_px > 0) TIFFSetField(tiff, TIFFTAG_TILEWIDTH, tile_px);
  if (tile_px > 0) TIFFSetField(tiff, TIFFTAG_TILELENGTH, tile_px);
  const std::uint32_t blocks = tile_px > 0 ? TIFFNumberOfTiles(tiff) : TIFFNumberOfStrips(tiff);
  for (std::uint32_t i = 0; i < blocks; ++i) {
    const std::size_t row_bytes = 3 * (tile_px > 0 ? side : static_cast<std::size_t>(width_px));
    for (std::size_t at = 0; at < block_bytes; ++at) block[at] = value_of(i, at / row_bytes);
    const auto bytes = static_cast<tmsize_t>(block_bytes);
    tile_px > 0 ? TIFFWriteEncodedTile(tiff, i, block.data(), bytes)
                : TIFFWriteEncodedStrip(tiff, i, block.data(), bytes);
  }
  TIFFClose(tiff);
}

/// The most that a process of its own holds while it cuts, KiB; none if it fails.
std::optional<long> peak_of_cut(const CutOptions& options) {
  const pid_t child = fork();
  if (child == 0) _exit(cut(options) ? 0 : 1);
  int status = -1;
  rusage used{};
  if (child < 0 || wait4(child, &status, 0, &used) != child) return {};
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return {};
  return used.ru_maxrss;
}

long own_peak() {
  rusage own{};
  getrusage(RUSAGE_SELF, &own);
  return own.ru_maxrss;
}

GeoRect north_of_greenwich(int width_px, int height_px, double pixel_deg) {
  return {.west = Angle::degrees(0.0),
          .south = Angle::degrees(90.0 - height_px * pixel_deg),
          .east = Angle::degrees(width_px * pixel_deg),
          .north = Angle::degrees(90.0)};
}

TEST(MemoryTest, DoesNotGrowWithTheHeight) {
  constexpr int kWidth_px = 2048;
  constexpr int kHeight_px = 32768;       // 256 MiB as RGBA
  constexpr long kMost_KiB = 128L << 10;  // strips, what runs ahead, libraries
  const ScratchFolder folder;
  write_tall_tiff(folder / "tall.tif", kWidth_px, kHeight_px);
  const auto peak = peak_of_cut({.images = {folder / "tall.tif"},
                                 .output = folder / "out.gpkg",
                                 .bounds = north_of_greenwich(kWidth_px, kHeight_px, 0.005)});
  ASSERT_TRUE(peak);
  EXPECT_LT(*peak, own_peak() + kMost_KiB);
}

TEST(MemoryTest, StripsThatAreKeptCountWithThoseThatAreLent) {
  constexpr std::size_t kMost_bytes = 10 * 16 * 16 * 4;
  StripPool pool(kMost_bytes);
  const auto shape = [](std::int64_t tiles) {
    return Strip{.level = 0, .tile_y = 0, .tile_x0 = 0, .tiles = tiles, .tile_px = 16, .rgba = {}};
  };
  for (const std::int64_t tiles : {4, 2, 4, 6, 3, 3, 3, 10, 1}) {
    const auto first = pool.lend(shape(tiles));
    EXPECT_LE(pool.held_bytes(), kMost_bytes) << tiles;
    if (tiles > 5) continue;
    const auto second = pool.lend(shape(tiles));
    EXPECT_LE(pool.held_bytes(), kMost_bytes) << tiles;
  }
  const auto too_large = pool.lend(shape(12));
  EXPECT_EQ(pool.held_bytes(), too_large->rgba.size());
}

/// A planet of 86400×43200 in 300 MB: its width decides, so a few rows of tiles tell.
class WidePictureTest : public testing::TestWithParam<int> {};

TEST_P(WidePictureTest, FitsInto300Megabytes) {
  constexpr int kWidth_px = 86400;
  constexpr int kHeight_px = 1100;  // the strips of three levels are full once and begun anew
  constexpr double kPixel_deg = 360.0 / kWidth_px;
  // The memory of an idle process does not count; under a sanitizer that is much more than in a program to use.
  constexpr long kProgram_KiB = 16L << 10;
  constexpr long kMost_KiB = 300'000'000L / 1024;
  const ScratchFolder folder;
  write_wide_bigtiff(folder / "wide.tif", kWidth_px, kHeight_px, GetParam());
  const auto peak = peak_of_cut({.images = {folder / "wide.tif"},
                                 .output = folder / "out.gpkg",
                                 .bounds = GeoRect{.west = Angle::degrees(-180.0),
                                                   .south = Angle::degrees(90.0 - kHeight_px * kPixel_deg),
                                                   .east = Angle::degrees(180.0),
                                                   .north = Angle::degrees(90.0)}});
  ASSERT_TRUE(peak);
  RecordProperty("peak_KiB", static_cast<int>(*peak));
  EXPECT_LT(*peak, std::max(0L, own_peak() - kProgram_KiB) + kMost_KiB);
}

/// A UTM picture of 40,000 columns becomes 59,400 columns of degrees; the blocks of the warp come in addition.
TEST(MemoryTest, AResampledPictureFitsInto300Megabytes) {
  constexpr int kWidth_px = 40000;
  constexpr int kHeight_px = 300;
  constexpr double kPixel_m = 10.0, kWest_m = 300e3, kNorth_m = 5300e3;
  constexpr long kProgram_KiB = 16L << 10;
  // A picture of 40,000 rows holds some 50 MB more: each thread's part of the heap grows with the time. GDAL's library
  // has 38 MB of it. It peaks at 249 MB, with pages of 2 MB at 251 MB, since a page counts as a whole.
  constexpr long kMost_KiB = 260'000'000L / 1024;
  const ScratchFolder folder;
  write_wide_bigtiff(folder / "utm.tif", kWidth_px, kHeight_px, 256);
  const auto peak = peak_of_cut({.images = {folder / "utm.tif"},
                                 .output = folder / "out.gpkg",
                                 .crs = "EPSG:32632",
                                 .crs_bounds = CrsBounds{.west = kWest_m,
                                                         .south = kNorth_m - kHeight_px * kPixel_m,
                                                         .east = kWest_m + kWidth_px * kPixel_m,
                                                         .north = kNorth_m}});
  ASSERT_TRUE(peak);
  RecordProperty("peak_KiB", static_cast<int>(*peak));
  EXPECT_LT(*peak, std::max(0L, own_peak() - kProgram_KiB) + kMost_KiB);
}

/// A row of tiles that is too large to be held is read a part of its rows at a time.
TEST(MemoryTest, PartsOfTilesAreTheRowsThatTheyWere) {
  constexpr int kWidth_px = 86400;
  constexpr int kHeight_px = 700;
  constexpr int kTile_px = 512;
  const ScratchFolder folder;
  write_wide_bigtiff(folder / "wide.tif", kWidth_px, kHeight_px, kTile_px);
  auto rows = open_rows(folder / "wide.tif");
  ASSERT_TRUE(rows) << rows.error().message;
  std::vector<std::uint8_t> row(std::size_t{kWidth_px} * 4);
  constexpr int kColumns = (kWidth_px + kTile_px - 1) / kTile_px;
  for (int y = 0; y < kHeight_px; ++y) {
    if (y == 20 || y == 500) {
      ASSERT_TRUE((*rows)->skip_rows(100));
      y += 100;
    }
    ASSERT_TRUE((*rows)->read_row(row));
    for (int x = 0; x < kWidth_px; x += 100) {
      const auto tile = static_cast<std::uint32_t>(y / kTile_px * kColumns + x / kTile_px);
      ASSERT_EQ(row[static_cast<std::size_t>(x) * 4 + 1], value_of(tile, static_cast<std::size_t>(y % kTile_px)))
          << x << " " << y;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(StripsAndTiles, WidePictureTest, testing::Values(0, 256, 512));

}  // namespace
}  // namespace terrella::test
