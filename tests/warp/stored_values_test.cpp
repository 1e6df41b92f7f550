// The value that a raster stores at a place is the one that gdallocationinfo prints, which has 15 digits, and to the
// last bit one of those that were written.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>
#include <set>

#include "geo/body.h"
#include "streaming/raster/open_raster.h"
#include "streaming/warp/warp_source.h"
#include "tests/support/scratch_folder.h"

namespace terrella {
namespace {

constexpr int kColumns = 150, kRows = 110, kPlaces = 1000;

/// A kind of sample. Its numbers are random in a range, in steps that 15 digits and the type hold exactly.
struct Sample {
  const char* type;
  double least, most, step, nodata;
};
constexpr Sample kSamples[] = {{"Byte", 0, 255, 1, 0},
                               {"UInt16", 0, 65535, 1, 65535},
                               {"Int16", -32768, 32767, 1, -32768},
                               {"Int32", -2147483648.0, 2147483647.0, 1, 0},
                               {"Float32", -1e5, 1e5, 1.0 / 64, -9999},
                               {"Float64", -1e9, 1e9, 1.0 / 16, -9999}};

/// A raster's place, its file's layout, and the degrees in which places are drawn by lot.
struct Placed {
  const char* name;
  const char* crs;
  Affine to_crs;
  const char* layout;
  double west, south, east, north;
};
void PrintTo(const Placed& placed, std::ostream* out) { *out << placed.name; }
const Placed kPlaced[] = {{"utm",
                           "EPSG:32633",
                           {.x0 = 4.0e5, .x_per_column = 3000.0, .y0 = 5.4e6, .y_per_row = -3000.0},
                           "-co TILED=YES -co BLOCKXSIZE=64 -co BLOCKYSIZE=48 -co COMPRESS=DEFLATE -co PREDICTOR=2",
                           14.0,
                           46.0,
                           19.0,
                           48.5},
                          {"degrees",
                           "EPSG:4326",
                           {.x0 = -180.0, .x_per_column = 2.4, .y0 = 90.0, .y_per_row = -1.6},
                           "",
                           -180.0,
                           -86.0,
                           180.0,
                           90.0},
                          {"pole",
                           "EPSG:3995",
                           {.x0 = -3.0e6, .x_per_column = 4.0e4, .y0 = 2.2e6, .y_per_row = -4.0e4},
                           "-co COMPRESS=LZW",
                           -180.0,
                           75.0,
                           180.0,
                           90.0}};

class StoredValues : public testing::TestWithParam<Placed> {
 protected:
  [[nodiscard]] bool run(const std::string& command) const {
    return std::system(("cd '" + (folder_ / "").string() + "' && (" + command + ") >log.txt 2>&1").c_str()) == 0;
  }
  /// Random numbers, one in twenty the raster's no-data value.
  void write(const Sample& sample) {
    std::ofstream file(folder_ / "numbers.asc");
    file << "ncols " << kColumns << "\nnrows " << kRows << "\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
    std::uniform_real_distribution<double> number(sample.least, sample.most);
    written_.clear();
    for (int k = 0; k < kColumns * kRows; ++k) {
      const double drawn = std::round(number(bits_) / sample.step) * sample.step;
      const double value = k % 20 == 7 ? sample.nodata : drawn;
      written_.insert(value);
      file << fmt::format("{:.15g}", value) << (k % kColumns == kColumns - 1 ? "\n" : " ");
    }
    file.close();
    const Placed& placed = GetParam();
    const CrsPoint lower = placed.to_crs.at(kColumns, kRows);
    const std::string predictor = std::string(sample.type).find("Float") == 0 ? "3" : "2";
    std::string layout = placed.layout;
    if (const auto at = layout.find("PREDICTOR=2"); at != std::string::npos) layout.replace(at + 10, 1, predictor);
    ASSERT_TRUE(
        run(fmt::format("{} -q -oo DATATYPE=Float64 -ot {} -a_srs {} -a_ullr {} {} {} {} -a_nodata {} {} "
                        "numbers.asc raster.tif",
                        GDAL_TRANSLATE, sample.type, placed.crs, placed.to_crs.x0, placed.to_crs.y0, lower.x, lower.y,
                        sample.nodata, layout)));
  }
  /// GDAL's output for the places: a line each, empty beside the raster.
  [[nodiscard]] std::vector<std::string> by_gdal(const std::vector<Geodetic>& places) const {
    std::ofstream file(folder_ / "places.txt");
    for (const Geodetic& place : places) file << fmt::format("{:.17g} {:.17g}\n", place.lon.deg(), place.lat.deg());
    file.close();
    EXPECT_TRUE(run(std::string(GDALLOCATIONINFO) + " -valonly -wgs84 raster.tif <places.txt >values.txt"));
    std::ifstream told(folder_ / "values.txt");
    std::vector<std::string> values;
    for (std::string line; std::getline(told, line);) values.push_back(line);
    return values;
  }
  std::set<double> written_;
  test::ScratchFolder folder_;
  std::mt19937_64 bits_{11};
};

TEST_P(StoredValues, AreThoseOfGdallocationinfoInEveryType) {
  const Placed& placed = GetParam();
  for (const Sample& sample : kSamples) {
    SCOPED_TRACE(sample.type);
    write(sample);
    auto raster = open_raster(folder_ / "raster.tif", {.to_crs = placed.to_crs, .crs = placed.crs}, {.heights = true});
    ASSERT_TRUE(raster) << raster.error().message;
    const Ellipsoid figure = earth().ellipsoid;
    const auto tiles =
        warp_source(*std::move(raster), {.figure = {.ellipsoid = figure}, .body = "earth"}, "raster.tif");
    ASSERT_TRUE(tiles) << tiles.error().message;
    std::vector<Geodetic> places;
    std::uniform_real_distribution<double> lat(placed.south, placed.north), lon(placed.west, placed.east);
    for (int k = 0; k < kPlaces; ++k) {
      places.push_back({.lat = Angle::degrees(lat(bits_)), .lon = Angle::degrees(lon(bits_))});
    }
    const std::vector<std::string> told = by_gdal(places);
    const std::string nodata = fmt::format("{:.15g}", sample.nodata);
    ASSERT_EQ(told.size(), places.size());
    int blank = 0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const auto value = (*tiles)->value_at(places[k], figure);
      SCOPED_TRACE(testing::Message() << places[k].lat.deg() << " N " << places[k].lon.deg() << " E");
      if (told[k] == nodata) {
        ++blank;
        ASSERT_FALSE(value);
        EXPECT_EQ(value.error().kind, MissingKind::blank);
      } else if (told[k].empty()) {
        ASSERT_FALSE(value);
        EXPECT_EQ(value.error().kind, MissingKind::absent);
      } else {
        ASSERT_TRUE(value) << value.error().why;
        EXPECT_EQ(fmt::format("{:.15g}", *value), told[k]);
        EXPECT_TRUE(written_.contains(*value));
      }
    }
    EXPECT_GT(blank, 20);
  }
}

INSTANTIATE_TEST_SUITE_P(Placed, StoredValues, testing::ValuesIn(kPlaced),
                         [](const auto& placed) { return std::string(placed.param.name); });

}  // namespace
}  // namespace terrella
