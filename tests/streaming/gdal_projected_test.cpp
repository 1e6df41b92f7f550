// GeoPackages that GDAL writes in coordinate systems of metres, and of other bodies. The truth is gdaltransform's: it
// leads from a spot in the tiles back to the picture.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "geo/body.h"
#include "streaming/sets/open_tile_set.h"
#include "streaming_test_support.h"
#include "tiles/tile_source.h"

namespace terrella {
namespace {

constexpr int kWide_px = 700, kHigh_px = 500;
constexpr double kSpotSigma_px = 2.5;
constexpr int kReach_px = 14;  ///< a spot is black beyond
/// Largest misplacement of a spot, pixels of the set. A tenth of it is what rounding to 8 bits leaves.
constexpr double kPlaced_px = 0.05;

struct Point {
  double x = 0.0, y = 0.0;
};
const std::vector<Point> kSpots = {{60.3, 50.8}, {351.2, 251.4}, {640.6, 80.1}, {255.7, 256.2}, {520.4, 440.9}};

double brightness(double x, double y) {
  double sum = 0.0;
  for (const Point& spot : kSpots) {
    sum += 240.0 * std::exp(-(std::pow(x - spot.x, 2) + std::pow(y - spot.y, 2)) / (2.0 * std::pow(kSpotSigma_px, 2)));
  }
  return sum;
}

struct Case {
  const char* name;
  const char* crs;
  const char* degrees;  ///< longitudes and latitudes of its body, for GDAL
  const char* body;
  double west, north, pixel;
  const char* options = "-co TILE_FORMAT=PNG";
  bool heights = false;
};
void PrintTo(const Case& given, std::ostream* out) { *out << given.name; }

/// A GeoPackage of a black picture with spots.
class ProjectedPackage : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream out(folder_ / "spots.pgm", std::ios::binary);
    out << "P5\n" << kWide_px << " " << kHigh_px << "\n255\n";
    for (int y = 0; y < kHigh_px; ++y) {
      for (int x = 0; x < kWide_px; ++x) out.put(static_cast<char>(std::lround(brightness(x + 0.5, y + 0.5))));
    }
  }

  [[nodiscard]] bool run(const std::string& command) const {
    const std::string in_folder = "cd '" + (folder_ / "").string() + "' && " + command + " >log.txt 2>&1";
    return std::system(in_folder.c_str()) == 0;
  }

  void write(const Case& given) const {
    const std::string place = fmt::format(" -a_srs '{}' -a_ullr {:.12g} {:.12g} {:.12g} {:.12g} {} spots.pgm a.gpkg",
                                          given.crs, given.west, given.north, given.west + kWide_px * given.pixel,
                                          given.north - kHigh_px * given.pixel, given.options);
    ASSERT_TRUE(run(std::string(GDAL_TRANSLATE) + " -q -of GPKG" + place));
    ASSERT_TRUE(run(std::string(GDALADDO) + " -q -r average a.gpkg 2 4"));
  }

  /// gdaltransform's answers.
  [[nodiscard]] std::vector<Point> transform(const std::string& from, const std::string& to,
                                             const std::vector<Point>& points) const {
    std::ofstream list(folder_ / "points.txt");
    for (const Point& point : points) list << fmt::format("{:.12f} {:.12f}\n", point.x, point.y);
    list.close();
    EXPECT_TRUE(run(fmt::format("{} -output_xy -s_srs '{}' -t_srs '{}' < points.txt", GDALTRANSFORM, from, to)));
    std::ifstream said(folder_ / "log.txt");
    std::vector<Point> answers(points.size());
    for (Point& answer : answers) said >> answer.x >> answer.y;
    EXPECT_TRUE(said);
    return answers;
  }

  [[nodiscard]] std::unique_ptr<TileSource> open() const {
    auto source = open_tile_set(folder_ / "a.gpkg");
    EXPECT_TRUE(source) << source.error().message;
    return source ? *std::move(source) : nullptr;
  }

  test::ScratchFolder folder_;
};
class GdalProjected : public ProjectedPackage, public testing::WithParamInterface<Case> {};

/// Brightness of the pixels of a set's finest level.
class FinestPixels {
 public:
  explicit FinestPixels(TileSource& source) : source_(source) {}
  double at(std::int64_t x, std::int64_t y) {
    const TileGrid& grid = source_.info().grid;
    const TileId id{grid.max_level, x / grid.tile_px, y / grid.tile_px};
    auto found = tiles_.find(id);
    if (found == tiles_.end()) found = tiles_.emplace(id, load(id)).first;
    const auto index = static_cast<std::size_t>((y % grid.tile_px) * grid.tile_px + x % grid.tile_px);
    return index < found->second.size() ? found->second[index] : 0.0;
  }

 private:
  std::vector<double> load(const TileId& id) {
    const Result<EncodedTile, TileFailure> tile = source_.read(id);
    if (!tile) return {};
    std::vector<double> values;
    if (tile->make_numbers) {
      const auto numbers = tile->make_numbers();
      if (!numbers) return {};
      const NumberInfo& set = *source_.info().numbers;
      for (const float number : numbers->values) {
        const double of_set = number * tile->number_scale + tile->number_offset;
        values.push_back(std::isfinite(number) ? of_set * set.scale + set.offset : 0.0);
      }
      return values;
    }
    const auto made = tile->make_picture ? tile->make_picture() : decoded(*tile);
    if (!made) return {};
    for (std::size_t i = 0; i < made->rgba.size(); i += 4) values.push_back(made->rgba[i]);
    return values;
  }
  static Result<Image, TileFailure> decoded(const EncodedTile& tile) {
    Result<Image> image = decode_image(tile.bytes);
    if (image) return *std::move(image);
    return TileFailure{MissingKind::broken, image.error().message};
  }

  TileSource& source_;
  std::map<TileId, std::vector<double>> tiles_;
};

/// Longitude and latitude of the middle of the brightness within `reach` degrees of a place.
Point middle_near(FinestPixels& pixels, const TileGrid& grid, const Point& place, const Point& reach) {
  const double pixel = tile_span_deg(grid, grid.max_level) / grid.tile_px;
  const auto column = [&](double lon) { return std::llround((lon - grid.west_deg) / pixel); };
  const auto row = [&](double lat) { return std::llround((top_row_deg(grid) - lat) / pixel); };
  double sum = 0.0, sum_x = 0.0, sum_y = 0.0;
  for (std::int64_t y = row(place.y + reach.y); y < row(place.y - reach.y); ++y) {
    for (std::int64_t x = column(place.x - reach.x); x < column(place.x + reach.x); ++x) {
      const double value = pixels.at(x, y);
      sum += value;
      sum_x += value * (static_cast<double>(x) + 0.5);
      sum_y += value * (static_cast<double>(y) + 0.5);
    }
  }
  EXPECT_GT(sum, 0.0);
  return {grid.west_deg + sum_x / sum * pixel, top_row_deg(grid) - sum_y / sum * pixel};
}

TEST_P(GdalProjected, SpotsAreWhereGdaltransformSaysTheyAre) {
  const Case& given = GetParam();
  ASSERT_NO_FATAL_FAILURE(write(given));
  const auto source = open();
  ASSERT_TRUE(source);
  EXPECT_EQ(source->info().body, given.body);
  EXPECT_EQ(source->info().numbers.has_value(), given.heights);
  std::vector<Point> points;  // three for each spot: its middle, and the ends of its reach
  for (const Point& spot : kSpots) {
    const Point at{given.west + spot.x * given.pixel, given.north - spot.y * given.pixel};
    const double reach = kReach_px * given.pixel;
    points.insert(points.end(), {at, {at.x + reach, at.y}, {at.x, at.y + reach}});
  }
  const std::vector<Point> places = transform(given.crs, given.degrees, points);
  FinestPixels pixels(*source);
  std::vector<Point> found;
  for (std::size_t i = 0; i < places.size(); i += 3) {
    const auto farthest = [&](auto&& part) {
      return std::hypot(part(places[i + 1]) - part(places[i]), part(places[i + 2]) - part(places[i]));
    };
    const Point reach{farthest([](const Point& p) { return p.x; }), farthest([](const Point& p) { return p.y; })};
    found.push_back(middle_near(pixels, source->info().grid, places[i], reach));
  }
  const std::vector<Point> back = transform(given.degrees, given.crs, found);
  for (std::size_t i = 0; i < kSpots.size(); ++i) {
    EXPECT_NEAR((back[i].x - given.west) / given.pixel, kSpots[i].x, kPlaced_px) << "spot " << i;
    EXPECT_NEAR((given.north - back[i].y) / given.pixel, kSpots[i].y, kPlaced_px) << "spot " << i;
  }
}

constexpr const char* kEarth = "EPSG:4326";
constexpr const char* kMoon = "+proj=longlat +R=1737400 +no_defs";
constexpr const char* kMars = "+proj=longlat +a=3396190 +b=3376200 +no_defs";

INSTANTIATE_TEST_SUITE_P(
    Systems, GdalProjected,
    testing::Values(
        Case{"Utm", "EPSG:32633", kEarth, "earth", 399900, 5500040, 60},
        Case{"UtmOfADroneInJpeg", "EPSG:32718", kEarth, "earth", 300000, 8500000, 0.5,
             "-co TILE_FORMAT=JPEG -co QUALITY=95"},
        Case{"UtmByDefault", "EPSG:25833", kEarth, "earth", 399900, 5500040, 60, ""},
        Case{"Polar", "EPSG:3413", kEarth, "earth", -1e6, -1.2e6, 1000},
        Case{"PolarOfTheSouth", "EPSG:3031", kEarth, "earth", 3e5, 1.9e6, 1000},
        Case{"Lambert", "EPSG:2154", kEarth, "earth", 300000, 6900000, 500},
        Case{"ShiftedDatum", "EPSG:4267", kEarth, "earth", -100, 45, 0.01},
        Case{"SameDegrees", "EPSG:4258", kEarth, "earth", 5, 50, 0.01},
        Case{"MoonInMetres", "+proj=stere +lat_0=90 +R=1737400 +no_defs", kMoon, "moon", -4e5, -1e5, 500},
        Case{"MoonInDegrees", kMoon, kMoon, "moon", -30, 40, 0.05},
        Case{"MoonOfTheIau", "IAU_2015:30100", "IAU_2015:30100", "moon", -30, 40, 0.05},
        Case{"MarsInMetres", "+proj=sinu +lon_0=20 +a=3396190 +b=3376200 +no_defs", kMars, "mars", -4e5, 1.9e6, 500},
        Case{"HeightsInUtm", "EPSG:32633", kEarth, "earth", 399900, 5500040, 60, "-ot Int16", true},
        Case{"FloatHeightsAtThePole", "EPSG:3413", kEarth, "earth", -1e6, -1.2e6, 1000, "-ot Float32", true},
        Case{"HeightsInWebMercator", "EPSG:3857", kEarth, "earth", 1e6, 6e6, 100, "-ot Int16", true}),
    [](const auto& given) { return std::string(given.param.name); });

/// A change that spoils a GeoPackage in UTM, and words of the message.
struct Spoilt {
  const char* name;
  const char* sql;
  std::vector<std::string> says;
};

const std::vector<Spoilt> kSpoilt = {
    {"NoRow", "DELETE FROM gpkg_spatial_ref_sys WHERE srs_id = 32633", {"srs_id 32633", "no known code"}},
    {"NoDefinition",
     "UPDATE gpkg_spatial_ref_sys SET organization = 'NONE', definition = '' WHERE srs_id = 32633",
     {"no known code and no WKT", "-a_srs"}},
    {"Undefined", "UPDATE gpkg_tile_matrix_set SET srs_id = -1", {"srs_id -1", "no known code"}},
    {"UnknownCode",
     "UPDATE gpkg_spatial_ref_sys SET organization_coordsys_id = 999999, definition = '' WHERE srs_id = 32633",
     {"EPSG:999999", "not one that PROJ knows"}},
    {"GridFile",
     "UPDATE gpkg_spatial_ref_sys SET organization = 'MINE', definition = "
     "'PROJCS[\"x\",EXTENSION[\"PROJ4\",\"+proj=utm "
     "+zone=33 +nadgrids=/etc/passwd\"]]' WHERE srs_id = 32633",
     {"MINE:32633", "file of datum shifts"}},
    {"Path",
     "UPDATE gpkg_spatial_ref_sys SET organization = 'NONE', definition = '@/etc/passwd' WHERE srs_id = 32633",
     {"no known code and no WKT"}},
    {"ProjPipeline",
     "UPDATE gpkg_spatial_ref_sys SET organization = '+init=epsg', definition = '' WHERE srs_id = 32633",
     {"coordinate system"}},
    {"DamagedWkt",
     "UPDATE gpkg_spatial_ref_sys SET organization = 'NONE', definition = 'PROJCS[\"x\",' WHERE srs_id = 32633",
     {"not one that PROJ knows"}},
    {"NoPlace",
     "UPDATE gpkg_tile_matrix_set SET min_x = min_x + 1e11, max_x = max_x + 1e11;"
     "UPDATE gpkg_contents SET min_x = min_x + 1e11, max_x = max_x + 1e11",
     {"place"}},
    {"VastCorner", "UPDATE gpkg_tile_matrix_set SET max_x = 1e300", {"corners of a rectangle"}},
    {"DataElsewhere", "UPDATE gpkg_contents SET min_x = 0, max_x = 10, min_y = 0, max_y = 10", {"bounds"}},
};

TEST_F(ProjectedPackage, OfASpoiltSystemIsRefusedByName) {
  const Case utm{"Utm", "EPSG:32633", kEarth, "earth", 399900, 5500040, 60};
  ASSERT_NO_FATAL_FAILURE(write(utm));
  const std::string path = (folder_ / "a.gpkg").string();
  ASSERT_TRUE(open());
  for (const Spoilt& spoilt : kSpoilt) {
    SCOPED_TRACE(spoilt.name);
    std::filesystem::copy_file(path, folder_ / "b.gpkg", std::filesystem::copy_options::overwrite_existing);
    test::run_sql(folder_ / "b.gpkg", spoilt.sql);
    const auto source = open_tile_set(folder_ / "b.gpkg");
    ASSERT_FALSE(source);
    const std::string& message = source.error().message;
    EXPECT_EQ(message.rfind((folder_ / "b.gpkg").string(), 0), 0U) << message;
    for (const std::string& text : spoilt.says) EXPECT_NE(message.find(text), std::string::npos) << message;
  }
}

/// The definition alone places the tiles, and its WKT 2 where there is no other.
TEST_F(ProjectedPackage, IsPlacedByItsDefinitionAlone) {
  const Case utm{"Utm", "EPSG:32633", kEarth, "earth", 399900, 5500040, 60};
  ASSERT_NO_FATAL_FAILURE(write(utm));
  const auto by_code = open();
  ASSERT_TRUE(by_code);
  test::run_sql(folder_ / "a.gpkg", "UPDATE gpkg_spatial_ref_sys SET organization = 'MINE' WHERE srs_id = 32633");
  const auto by_wkt = open();
  ASSERT_TRUE(by_wkt);
  EXPECT_EQ(by_wkt->info().grid, by_code->info().grid);
  EXPECT_EQ(by_wkt->info().square->crs.rfind("PROJCS[", 0), 0U);
}

}  // namespace
}  // namespace terrella
