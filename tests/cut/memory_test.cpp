#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <tiffio.h>
#include <unistd.h>

#include "picture_files.h"
#include "streaming/cut.h"

namespace terrella::test {
namespace {

/// Rows of one colour each: quick to write and small on the disk, whatever the height.
void write_tall_tiff(const std::filesystem::path& path, int width_px, int height_px) {
  TIFF* tiff = TIFFOpen(path.c_str(), "w");
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width_px);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height_px);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 3);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_PACKBITS);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 64);
  for (int y = 0; y < height_px; ++y) {
    std::vector<std::uint8_t> row(static_cast<std::size_t>(width_px) * 3, static_cast<std::uint8_t>(y));
    TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(y), 0);
  }
  TIFFClose(tiff);
}

TEST(MemoryTest, DoesNotGrowWithTheHeight) {
  constexpr int kWidth_px = 2048;
  constexpr int kHeight_px = 32768;       // 256 MiB as RGBA
  constexpr long kMost_KiB = 128L << 10;  // strips, what runs ahead, libraries
  constexpr double kPixel_deg = 0.005;
  const TestFolder folder;
  write_tall_tiff(folder / "tall.tif", kWidth_px, kHeight_px);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const GeoRect bounds{.west = Angle::degrees(0.0),
                         .south = Angle::degrees(90.0 - kHeight_px * kPixel_deg),
                         .east = Angle::degrees(kWidth_px * kPixel_deg),
                         .north = Angle::degrees(90.0)};
    const auto made = cut({.images = {folder / "tall.tif"}, .output = folder / "out.gpkg", .bounds = bounds});
    _exit(made ? 0 : 1);
  }
  int status = -1;
  rusage used{};
  ASSERT_EQ(wait4(child, &status, 0, &used), child);
  ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  rusage own{};
  getrusage(RUSAGE_SELF, &own);
  EXPECT_LT(used.ru_maxrss, own.ru_maxrss + kMost_KiB);
}

}  // namespace
}  // namespace terrella::test
