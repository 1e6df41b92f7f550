#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "geo/body.h"
#include "raster_files.h"
#include "streaming/cut.h"
#include "streaming/sets/open_tile_set.h"
#include "streaming/warp/warp_source.h"

namespace terrella::test {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 400, kHeight = 200;
constexpr int kPlaces = 1000;

struct NumberType {
  const char* name;
  double least, most;
  bool whole;
  const char* options;  ///< options for gdal_translate
};

// Printed by Google Test for each parameter.
void PrintTo(const NumberType& type, std::ostream* out) { *out << type.name << " " << type.options; }

struct Place {
  double lon_deg, lat_deg;
};

/// Random places, none on the edge of a pixel, where rounding decides.
std::vector<Place> places() {
  std::mt19937 random(24);
  std::uniform_int_distribution<int> column(0, kWidth - 1), row(0, kHeight - 1);
  std::uniform_real_distribution<double> inside(0.05, 0.95);
  std::vector<Place> made;
  for (int i = 0; i < kPlaces; ++i) {
    made.push_back({-180.0 + (column(random) + inside(random)) * 360.0 / kWidth,
                    90.0 - (row(random) + inside(random)) * 180.0 / kHeight});
  }
  return made;
}

/// GDAL's value at each place; NaN beside the raster.
std::vector<double> by_gdal(const fs::path& raster, const std::vector<Place>& at, const fs::path& folder) {
  std::ofstream points(folder / "points.txt");
  for (const Place& place : at) points << fmt::format("{:.12f} {:.12f}\n", place.lon_deg, place.lat_deg);
  points.close();
  EXPECT_TRUE(run(fmt::format("( {} -valonly -wgs84 {} < {} > {} )", TERRELLA_GDALLOCATIONINFO, raster.string(),
                              (folder / "points.txt").string(), (folder / "values.txt").string())));
  std::ifstream values(folder / "values.txt");
  std::vector<double> read;
  for (std::string line; std::getline(values, line);)
    read.push_back(line.empty() ? NAN : std::strtod(line.c_str(), nullptr));
  EXPECT_EQ(read.size(), at.size());
  return read;
}

fs::path make_raster(const NumberType& type, const fs::path& folder) {
  write_raw(folder / "in.raw", type.name, kWidth, kHeight, 1, [&](int x, int y, int) {
    const double value = type.least + (type.most - type.least) * noise_at(x, y, 0);
    if (x < 40 && y < 40) return type.least;  // the no-data value of the types that have one
    return type.whole ? std::round(value) : value;
  });
  EXPECT_TRUE(translate(fmt::format("-a_srs EPSG:4326 -a_ullr -180 90 180 -90 {}", type.options), folder / "in.raw",
                        folder / "in.tif"));
  return folder / "in.tif";
}

struct Expected {
  double scale = 1.0, offset = 0.0;
  std::optional<double> nodata = {};
};

/// Compares a set's values with GDAL's. GDAL's numbers of 64 bits are compared as floats, which is what sets keep.
void expect_same(TileSource& tiles, const std::vector<double>& gdal, const Expected& raster) {
  const std::vector<Place> at = places();
  int unknown = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Geodetic place{.lat = Angle::degrees(at[i].lat_deg), .lon = Angle::degrees(at[i].lon_deg)};
    const auto value = tiles.value_at(place, earth().ellipsoid);
    if (gdal[i] == raster.nodata) {
      ASSERT_FALSE(value) << i;
      EXPECT_EQ(value.error().kind, MissingKind::blank) << value.error().why;
      ++unknown;
      continue;
    }
    ASSERT_TRUE(value) << i << ": " << value.error().why;
    const double truth = gdal[i] * raster.scale + raster.offset;
    EXPECT_EQ(static_cast<float>(*value), static_cast<float>(truth)) << i;
  }
  EXPECT_EQ(unknown > 0, raster.nodata.has_value());
}

class ExactValuesTest : public testing::TestWithParam<NumberType> {
 protected:
  /// The meaning of the raster, by the options with which it was made.
  [[nodiscard]] static Expected expected() {
    Expected raster;
    const std::string options = GetParam().options;
    if (options.find("-a_scale") != std::string::npos) raster = {.scale = 0.001, .offset = 5.0};
    if (options.find("-a_nodata") != std::string::npos) raster.nodata = GetParam().least;
    return raster;
  }
};

TEST_P(ExactValuesTest, ShownDirectly) {
  const ScratchFolder folder;
  const fs::path raster = make_raster(GetParam(), folder.path());
  const CrsPlace place{.to_crs = {-180.0, 360.0 / kWidth, 0.0, 90.0, 0.0, -180.0 / kHeight}, .crs = "EPSG:4326"};
  auto opened = open_raster(raster, place, {.heights = true, .stored = true});
  ASSERT_TRUE(opened) << opened.error().message;
  auto tiles = warp_source(*std::move(opened), {.figure = {earth().ellipsoid, {}, {}}, .tile_px = 64}, "in.tif");
  ASSERT_TRUE(tiles) << tiles.error().message;
  expect_same(**tiles, by_gdal(raster, places(), folder.path()), expected());
}

TEST_P(ExactValuesTest, CutIntoAGeoPackageThatGdalReadsToo) {
  const ScratchFolder folder;
  const fs::path raster = make_raster(GetParam(), folder.path());
  const auto done = cut({.images = {raster}, .output = folder / "out.gpkg", .tile_px = 64, .numbers = CutNumbers{}});
  ASSERT_TRUE(done) << done.error().message;
  const auto tiles = open_tile_set(folder / "out.gpkg");
  ASSERT_TRUE(tiles) << tiles.error().message;
  const auto stored = by_gdal(raster, places(), folder.path());
  expect_same(**tiles, stored, expected());
  const auto read = by_gdal(folder / "out.gpkg", places(), folder.path());
  for (std::size_t i = 0; i < read.size(); ++i) {
    if (stored[i] == expected().nodata) continue;
    EXPECT_EQ(static_cast<float>(read[i]), static_cast<float>(stored[i] * expected().scale + expected().offset)) << i;
  }
}

TEST_P(ExactValuesTest, CutIntoAFolder) {
  const ScratchFolder folder;
  const fs::path raster = make_raster(GetParam(), folder.path());
  const auto done = cut({.images = {raster}, .output = folder / "out", .tile_px = 64, .numbers = CutNumbers{}});
  ASSERT_TRUE(done) << done.error().message;
  const auto tiles = open_tile_set(folder / "out");
  ASSERT_TRUE(tiles) << tiles.error().message;
  expect_same(**tiles, by_gdal(raster, places(), folder.path()), expected());
}

constexpr const char* kMeaning = "-a_nodata -20000 -a_scale 0.001 -a_offset 5 -mo X=1";

INSTANTIATE_TEST_SUITE_P(
    Types, ExactValuesTest,
    testing::Values(NumberType{"Byte", 0, 255, true, "-co TILED=YES -co BLOCKXSIZE=64 -co BLOCKYSIZE=64"},
                    NumberType{"UInt16", 1000, 65535, true, "-a_nodata 1000"},
                    NumberType{"UInt16", 0, 65535, true, "-co TILED=YES"},
                    NumberType{"Int16", -20000, 32767, true, kMeaning}, NumberType{"Int16", -32768, 32767, true, ""},
                    NumberType{"Float32", -2.5, 31.25, false, "-co TILED=YES -co COMPRESS=DEFLATE -co PREDICTOR=3"},
                    NumberType{"Float32", -9999, 12, false, "-a_nodata -9999"},
                    NumberType{"Float64", -1e5, 1e5, false, "-a_nodata -100000 -co COMPRESS=LZW"}));

}  // namespace
}  // namespace terrella::test
