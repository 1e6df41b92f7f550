// Samples of unusual bits come out as GDAL reads them, and so does what a file beside the TIFF says of them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "raster_files.h"
#include "streaming/raster/raster_file.h"

namespace terrella::test {
namespace {

// Odd sides: rows of most bit sizes end within a byte.
constexpr int kBitsWide = 173;
constexpr int kBitsHigh = 67;

struct Bits {
  const char* name;
  const char* type;     ///< as gdal_translate names it
  const char* options;  ///< options of gdal_translate
  double least, most;
};
constexpr Bits kBits[] = {
    {"uint3", "Byte", "-co NBITS=3", 0, 7},
    {"uint7", "Byte", "-co NBITS=7", 0, 127},
    {"uint9", "UInt16", "-co NBITS=9", 0, 511},
    {"uint12", "UInt16", "-co NBITS=12", 0, 4095},
    {"uint14", "UInt16", "-co NBITS=14", 0, 16383},
    {"uint17", "UInt32", "-co NBITS=17", 0, 131071},
    {"uint24", "UInt32", "-co NBITS=24", 0, 16777215},
    {"float16", "Float32", "-co NBITS=16", -2000, 2000},
    {"int64", "Int64", "", -8e6, 8e6},
    {"uint64", "UInt64", "", 0, 16777215},
};
void PrintTo(const Bits& bits, std::ostream* out) { *out << bits.name; }

class TiffBits : public testing::TestWithParam<Bits> {};

TEST_P(TiffBits, AreThoseOfGdal) {
  const Bits& bits = GetParam();
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Float64", kBitsWide, kBitsHigh, 2, [&](int x, int y, int band) {
    return std::floor(bits.least + noise_at(x, y, band) * (bits.most - bits.least + 1.0));
  });
  for (const char* layout : {"", "-co COMPRESS=DEFLATE", "-co TILED=YES -co BLOCKXSIZE=48 -co BLOCKYSIZE=32",
                             "-co TILED=YES -co INTERLEAVE=BAND", "-co ENDIANNESS=BIG"}) {
    SCOPED_TRACE(layout);
    ASSERT_TRUE(
        translate(fmt::format("-ot {} {} {}", bits.type, bits.options, layout), folder / "in.raw", folder / "in.tif"));
    const GdalPixels expected = read_by_gdal(folder / "in.tif", 2);
    for (const int band : {1, 2}) {
      const auto source = open_raster(folder / "in.tif", some_place(), {.heights = true, .band = band});
      ASSERT_TRUE(source) << source.error().message;
      const Numbers got = whole_numbers(**source, 0);
      for (int y = 0; y < kBitsHigh; ++y) {
        for (int x = 0; x < kBitsWide; ++x) {
          const double value = expected.at(x, y, band - 1);
          ASSERT_EQ(got.values[static_cast<std::size_t>(y) * kBitsWide + x], static_cast<float>(value))
              << x << " " << y;
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Types, TiffBits, testing::ValuesIn(kBits), [](const auto& test) { return test.param.name; });

TEST(TiffBitsTest, ComplexNumbersAreRefused) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "UInt16", kBitsWide, kBitsHigh, 1, [](int x, int, int) { return x; });
  ASSERT_TRUE(translate("-ot CInt16", folder / "in.raw", folder / "complex.tif"));
  EXPECT_FALSE(open_raster(folder / "complex.tif", some_place(), {}));
}

/// A picture of 12 bits is shown by the range of 12 bits, not by that of 16.
TEST(TiffBitsTest, APictureOfTwelveBitsHasItsWholeRange) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "UInt16", 128, 64, 3, [](int x, int y, int) { return 32 * x + y % 2; });
  ASSERT_TRUE(translate("-co NBITS=12 -co PHOTOMETRIC=RGB", folder / "in.raw", folder / "in.tif"));
  const auto source = open_raster(folder / "in.tif", some_place(), {});
  ASSERT_TRUE(source) << source.error().message;
  const Image got = whole_picture(**source, 0);
  for (int x = 0; x < 128; ++x) ASSERT_EQ(got.rgba[4 * x + 1], std::round(32 * x * 255.0 / 4095.0)) << x;
}

/// GDAL writes what a TIFF's profile has no tags for into a file beside it.
TEST(TiffBitsTest, AFileBesideTheTiffSaysWhatItsNumbersMean) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Int16", kBitsWide, kBitsHigh, 1, [](int x, int, int) { return x % 50; });
  ASSERT_TRUE(translate("-co PROFILE=BASELINE -a_nodata 7 -stats", folder / "in.raw", folder / "in.tif"));
  ASSERT_TRUE(std::filesystem::exists(folder / "in.tif.aux.xml"));
  const auto file = RasterFile::open(folder / "in.tif");
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ((*file)->header().bands[0].nodata, 7.0);
  EXPECT_EQ((*file)->header().bands[0].most, 49.0);
  const auto source = open_raster(folder / "in.tif", some_place(), {.heights = true});
  ASSERT_TRUE(source) << source.error().message;
  const Numbers got = whole_numbers(**source, 0);
  EXPECT_TRUE(std::isnan(got.values[7]));
  EXPECT_EQ(got.values[8], 8.0F);

  // No data of that file wins over the tag, and scale and offset of the tags win over that file (gdalinfo of GDAL 3.6).
  ASSERT_TRUE(translate("-a_nodata 7 -a_scale 0.5 -a_offset -3", folder / "in.raw", folder / "both.tif"));
  std::ofstream(folder / "both.tif.aux.xml") << R"(<PAMDataset><PAMRasterBand band="1"><NoDataValue>9</NoDataValue>
    <Offset>1</Offset><Scale>2</Scale><UnitType>ft</UnitType></PAMRasterBand></PAMDataset>)";
  const auto both = RasterFile::open(folder / "both.tif");
  ASSERT_TRUE(both) << both.error().message;
  const RasterBand& band = (*both)->header().bands[0];
  EXPECT_EQ(band.nodata, 9.0);
  EXPECT_EQ(band.scale, 0.5);
  EXPECT_EQ(band.offset, -3.0);
  EXPECT_EQ(band.unit, "ft");
  ASSERT_TRUE(translate("", folder / "in.raw", folder / "plain.tif"));
  std::filesystem::copy_file(folder / "both.tif.aux.xml", folder / "plain.tif.aux.xml");
  EXPECT_EQ((*RasterFile::open(folder / "plain.tif"))->header().bands[0].scale, 2.0);
}

/// Bands in another order than red, green and blue: a near infrared first, as satellites have them.
TEST(TiffBitsTest, BandsHaveTheColoursThatAreStated) {
  const ScratchFolder folder;
  write_raw(folder / "in.raw", "Byte", 128, 64, 4, [](int x, int, int band) { return x + 20 * band; });
  for (const char* options : {"-colorinterp undefined,blue,green,red -co PHOTOMETRIC=MINISBLACK",
                              "-b 2 -b 3 -b 4 -colorinterp blue,green,red"}) {
    ASSERT_TRUE(translate(options, folder / "in.raw", folder / "in.tif"));
    const auto source = open_raster(folder / "in.tif", some_place(), {});
    ASSERT_TRUE(source) << source.error().message;
    const Image got = whole_picture(**source, 0);
    for (int c = 0; c < 3; ++c) ASSERT_EQ(got.rgba[4 * 5 + c], 5 + 20 * (3 - c)) << options;
    ASSERT_EQ(got.rgba[4 * 5 + 3], 255);
  }
}

}  // namespace
}  // namespace terrella::test
