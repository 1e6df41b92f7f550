#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <fstream>

#include "raster_files.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

enum FieldType : std::uint16_t { kByte = 1, kText = 2, kShort = 3, kLong = 4, kDouble = 12 };

struct Field {
  std::uint16_t tag;
  std::uint16_t type;
  std::uint32_t count;
  std::uint32_t value;
};

/// A small valid TIFF (64x64, tiles of 32x32, gray, bytes) whose fields can be replaced.
class TiffBytes {
 public:
  TiffBytes& set(std::uint16_t tag, std::uint16_t type, std::uint32_t count, std::uint32_t value) {
    std::erase_if(fields_, [tag](const Field& field) { return field.tag == tag; });
    fields_.push_back({tag, type, count, value});
    std::ranges::sort(fields_, {}, &Field::tag);
    return *this;
  }
  TiffBytes& next(std::uint32_t offset) {
    next_ = offset;
    return *this;
  }
  void write(const fs::path& path) const {
    std::string bytes("II*\0", 4);
    put(bytes, kDirectory, 4);
    bytes.resize(kTables);
    for (std::uint32_t i = 0; i < 4; ++i) put(bytes, kPixels + i * 1024, 4);
    for (std::uint32_t i = 0; i < 4; ++i) put(bytes, 1024, 4);
    bytes.resize(kPixels + 4096, '\x40');
    bytes.resize(kDirectory);
    put(bytes, static_cast<std::uint32_t>(fields_.size()), 2);
    for (const Field& field : fields_) {
      put(bytes, field.tag, 2);
      put(bytes, field.type, 2);
      put(bytes, field.count, 4);
      put(bytes, field.value, 4);
    }
    put(bytes, next_, 4);
    std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  static constexpr std::uint32_t kTables = 64;
  static constexpr std::uint32_t kPixels = 256;
  static constexpr std::uint32_t kDirectory = 8192;

 private:
  static void put(std::string& bytes, std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) bytes.push_back(static_cast<char>(value >> (8 * i)));
  }
  std::vector<Field> fields_{{256, kShort, 1, 64},         {257, kShort, 1, 64}, {258, kShort, 1, 8},
                             {259, kShort, 1, 1},          {262, kShort, 1, 1},  {277, kShort, 1, 1},
                             {322, kShort, 1, 32},         {323, kShort, 1, 32}, {324, kLong, 4, kTables},
                             {325, kLong, 4, kTables + 16}};
  std::uint32_t next_ = 0;
};

/// The most memory that this process has held, KiB.
long peak_KiB() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return used.ru_maxrss;
}

/// Opens the raster and reads all blocks; the first error that names the file, or nothing.
std::string first_error(const fs::path& path) {
  const auto source = open_raster(path, some_place());
  if (!source) return source.error().message;
  for (std::size_t i = 0; i < (*source)->info().levels.size(); ++i) {
    const RasterLevel& level = (*source)->info().levels[i];
    for (std::int64_t y = 0; y < 4 && y * level.block_height_px < level.height_px; ++y) {
      for (std::int64_t x = 0; x < 4 && x * level.block_width_px < level.width_px; ++x) {
        auto tile = (*source)->read({.level = static_cast<int>(i), .x = x, .y = y});
        if (!tile) return tile.error().why;
        const auto image = tile->make_picture();
        if (!image) return image.error().why;
      }
    }
  }
  return {};
}

TEST(HostileRasterTest, TheUnharmedFileIsRead) {
  const ScratchFolder folder;
  TiffBytes().write(folder / "a.tif");
  EXPECT_EQ(first_error(folder / "a.tif"), "");
}

/// A picture that names itself as its overview, or as the next picture, is read as it is.
TEST(HostileRasterTest, APictureIsNotItsOwnOverview) {
  const ScratchFolder folder;
  for (const TiffBytes& bytes :
       {TiffBytes().set(330, kLong, 1, TiffBytes::kDirectory), TiffBytes().next(TiffBytes::kDirectory)}) {
    bytes.write(folder / "a.tif");
    EXPECT_EQ(first_error(folder / "a.tif"), "");
    const auto source = open_raster(folder / "a.tif", some_place());
    ASSERT_TRUE(source);
    EXPECT_EQ((*source)->info().levels.size(), 1U);
  }
}

struct Harm {
  const char* name;
  TiffBytes bytes;
  const char* part;  ///< part of the message
  friend void PrintTo(const Harm& one, std::ostream* out) { *out << one.name; }
};

class Hostile : public testing::TestWithParam<Harm> {};

/// Every harm is an error that names the file and the harm, without a crash and without much memory.
TEST_P(Hostile, IsNamed) {
  constexpr long kMost_KiB = 64L << 10;
  const ScratchFolder folder;
  GetParam().bytes.write(folder / "a.tif");
  const long before = peak_KiB();
  const std::string message = first_error(folder / "a.tif");
  EXPECT_NE(message.find((folder / "a.tif").string()), std::string::npos) << message;
  EXPECT_NE(message.find(GetParam().part), std::string::npos) << message;
  EXPECT_LT(peak_KiB() - before, kMost_KiB);
}

constexpr std::uint32_t kEnd = TiffBytes::kDirectory;

INSTANTIATE_TEST_SUITE_P(
    Files, Hostile,
    testing::Values(Harm{"no_width", TiffBytes().set(256, kShort, 1, 0), "zero number"},
                    Harm{"no_height", TiffBytes().set(257, kShort, 1, 0), "zero number"},
                    Harm{"huge_sides", TiffBytes().set(256, kLong, 1, 0x7fffffff).set(257, kLong, 1, 0x7fffffff),
                         "Integer overflow"},
                    Harm{"many_tiles",
                         TiffBytes()
                             .set(256, kLong, 1, 1 << 20)
                             .set(257, kLong, 1, 1 << 20)
                             .set(322, kShort, 1, 16)
                             .set(323, kShort, 1, 16),
                         "Integer overflow"},
                    Harm{"two_to_the_31_tiles",
                         TiffBytes()
                             .set(256, kLong, 1, 1 << 20)
                             .set(257, kLong, 1, 1 << 20)
                             .set(322, kShort, 1, 16)
                             .set(323, kShort, 1, 16)
                             .set(324, kLong, 0x7fffffff, 64)
                             .set(325, kLong, 0x7fffffff, 64),
                         ""},
                    Harm{"tile_without_width", TiffBytes().set(322, kShort, 1, 0), ""},
                    Harm{"tile_without_height", TiffBytes().set(323, kShort, 1, 0), ""},
                    Harm{"huge_tiles", TiffBytes().set(322, kLong, 1, 1 << 20).set(323, kLong, 1, 1 << 16), ""},
                    Harm{"offsets_beyond_the_end", TiffBytes().set(324, kLong, 4, kEnd - 8), ""},
                    Harm{"table_beyond_the_end", TiffBytes().set(324, kLong, 4, 0x7ffffff0), ""},
                    Harm{"width_as_double", TiffBytes().set(256, kDouble, 1, 64), ""},
                    Harm{"offsets_as_text", TiffBytes().set(324, kText, 4, 64), ""},
                    Harm{"directory_beyond_the_end", TiffBytes().next(0x7fffff00), "TIFF directory"},
                    Harm{"directory_in_the_pixels", TiffBytes().next(TiffBytes::kPixels), ""},
                    Harm{"children_beyond_the_end", TiffBytes().set(330, kLong, 1, 0x7fffff00), "TIFF directory"},
                    Harm{"no_compression_known", TiffBytes().set(259, kShort, 1, 999), "codec of code 999"},
                    Harm{"deflate_of_no_deflate", TiffBytes().set(259, kShort, 1, 8), "block 0, 0 of level 0"},
                    Harm{"bits", TiffBytes().set(258, kShort, 1, 33), "BitsPerSample(=33)"},
                    Harm{"samples", TiffBytes().set(277, kShort, 1, 0), ""},
                    Harm{"colour_space", TiffBytes().set(262, kShort, 1, 8), "its colours are not"},
                    Harm{"complex", TiffBytes().set(258, kShort, 1, 64).set(339, kShort, 1, 6), "complex"}),
    [](const auto& test) { return test.param.name; });

TEST(HostileRasterTest, ATruncatedFileNamesTheBlock) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Byte", 256, 256, 1,
            [](int x, int y, int) { return std::floor(256.0 * noise_at(x, y, 0)); });
  for (const char* options : {"-co TILED=YES -co BLOCKXSIZE=64 -co BLOCKYSIZE=64", "-co COMPRESS=DEFLATE"}) {
    ASSERT_TRUE(translate(options, folder / "in.raw", folder / "in.tif"));
    fs::resize_file(folder / "in.tif", fs::file_size(folder / "in.tif") / 2);
    const std::string message = first_error(folder / "in.tif");
    EXPECT_NE(message.find((folder / "in.tif").string()), std::string::npos) << message;
    EXPECT_NE(message.find("get it again"), std::string::npos) << message;
  }
}

TEST(HostileRasterTest, FilesThatAreNoTiff) {
  const ScratchFolder folder;
  std::ofstream(folder / "text.tif") << "no picture";
  std::ofstream(folder / "empty.tif");
  for (const char* name : {"text.tif", "empty.tif", "nowhere.tif", ""}) {
    const auto source = open_raster(folder / name, some_place());
    ASSERT_FALSE(source);
    EXPECT_NE(source.error().message.find((folder / name).string()), std::string::npos) << source.error().message;
  }
}

}  // namespace
}  // namespace terrella::test
