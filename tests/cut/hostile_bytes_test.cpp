#include <gtest/gtest.h>
#include <tiffio.h>

#include <random>

#include "picture_files.h"
#include "tiff_files.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

/// Bytes changed at random in a good picture: whatever comes, it is pixels or an error. Sanitizers see the rest.
void spoil_and_read(const ScratchFolder& folder, const fs::path& good) {
  constexpr int kTrials = 150;
  const auto bytes = read_bytes(good);
  std::mt19937 random(7);
  for (int trial = 0; trial < kTrials; ++trial) {
    auto spoilt = bytes;
    // Headers and directories are what decides sizes: they stand within the first or the last few hundred bytes.
    const std::size_t reach = std::min<std::size_t>(spoilt.size(), 300);
    for (unsigned change = random() % 4; change <= 4; ++change) {
      const std::size_t at = random() % reach;
      spoilt[random() % 2 == 0 ? at : spoilt.size() - 1 - at] = static_cast<std::byte>(random() & 255U);
    }
    if (random() % 4 == 0) spoilt.resize(random() % spoilt.size());
    write_bytes(folder / "spoilt", spoilt);
    const auto read = read_all_rows(folder / "spoilt");
    if (!read) {
      EXPECT_NE(read.error().message.find("spoilt"), std::string::npos) << read.error().message;
    }
  }
}

TEST(HostileBytesTest, EndInPixelsOrAnError) {
  const ScratchFolder folder;
  const Image picture = noise(48, 24, true);
  write_png(folder / "a.png", picture);
  write_interlaced_png(folder / "b.png", picture);
  write_jpeg(folder / "a.jpg", picture);
  write_jpeg(folder / "b.jpg", picture, true);
  for (const char* name : {"a.png", "b.png", "a.jpg", "b.jpg"}) spoil_and_read(folder, folder / name);
}

TEST(HostileBytesTest, TiffsToo) {
  const ScratchFolder folder;
  const Image picture = noise(48, 24, true);
  const std::vector<TiffKind> kinds = {
      {},
      {.tile_px = 16},
      {.compression = COMPRESSION_LZW},
      {.photometric = PHOTOMETRIC_PALETTE},
      {.big = true},
      {.photometric = PHOTOMETRIC_YCBCR, .compression = COMPRESSION_JPEG, .rows_per_strip = 16}};
  for (const TiffKind& kind : kinds) {
    write_tiff(folder / "good.tif", picture, kind);
    spoil_and_read(folder, folder / "good.tif");
  }
}

}  // namespace
}  // namespace terrella::test
