#include "streaming/objects/vector_objects.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <random>

// The library that GDAL reads KMZ with loses the bytes of an archive that it refuses. LeakSanitizer asks this function.
extern "C" const char* __lsan_default_suppressions() { return "leak:libkml"; }

namespace terrella {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// GDAL's own program writes the files, so no reader is compared with itself.
class VectorObjects : public testing::Test {
 protected:
  VectorObjects() {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~VectorObjects() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  fs::path convert(const fs::path& from, const std::string& name, const std::string& options) const {
    const fs::path to = folder_ / name;
    const std::string command = fmt::format("ogr2ogr {} '{}' '{}'", options, to.string(), from.string());
    EXPECT_EQ(std::system(command.c_str()), 0) << command;  // NOLINT(cert-env33-c): a fixed command
    return to;
  }

  static ObjectFile good(const fs::path& path) {
    auto file = read_objects(path);
    EXPECT_TRUE(file) << file.error().message;
    return file ? *std::move(file) : ObjectFile{};
  }

  const fs::path folder_ = fs::temp_directory_path() / fmt::format("terrella_vector_{}", std::random_device{}());
};

/// 2e-8 degrees are 2 mm: projections of PROJ return within less.
constexpr double kReturn_deg = 2.0e-8;

void expect_same(const Geodetic& a, const Geodetic& b, const std::string& what) {
  EXPECT_NEAR(a.lat.deg(), b.lat.deg(), kReturn_deg) << what;
  EXPECT_NEAR(std::remainder(a.lon.deg() - b.lon.deg(), 360.0), 0.0, kReturn_deg) << what;
}

void expect_same(const std::vector<Geodetic>& a, const std::vector<Geodetic>& b, const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (std::size_t i = 0; i < a.size(); ++i) expect_same(a[i], b[i], what);
}

std::string points(int count, double west, double south, double size_deg) {
  std::mt19937 random(32);
  std::uniform_real_distribution<double> part(0.0, size_deg);
  std::string features;
  for (int i = 0; i < count; ++i) {
    features += fmt::format(
        R"({}{{"type":"Feature","properties":{{"name":"p{}","n":{}}},"geometry":{{"type":"Point","coordinates":[{:.9f},{:.9f}]}}}})",
        i == 0 ? "" : ",", i, i, west + part(random), south + part(random));
  }
  return R"({"type":"FeatureCollection","features":[)" + features + "]}";
}

TEST_F(VectorObjects, TwoHundredPointsOfEveryFormatAndSystemLieWhereGeoJsonSays) {
  const fs::path source = write("points.geojson", points(200, 6.0, 45.0, 5.0));
  const ObjectFile expected = good(source);
  const std::vector<std::pair<std::string, std::string>> files{{"a.kml", "-f LIBKML"},
                                                               {"a.kmz", "-f LIBKML"},
                                                               {"a.gpx", "-f GPX -nln waypoints -select name"},
                                                               {"a.fgb", "-f FlatGeobuf -lco SPATIAL_INDEX=NO"},
                                                               {"a.gpkg", "-f GPKG"},
                                                               {"a.csv", "-f CSV -lco GEOMETRY=AS_XY"},
                                                               {"wkt.csv", "-f CSV -lco GEOMETRY=AS_WKT"},
                                                               {"utm.shp", "-f 'ESRI Shapefile' -t_srs EPSG:32632"},
                                                               {"mercator.shp", "-f 'ESRI Shapefile' -t_srs EPSG:3857"},
                                                               {"lcc.gpkg", "-f GPKG -t_srs EPSG:3034"}};
  for (const auto& [name, options] : files) {
    const ObjectFile file = good(convert(source, name, options));
    EXPECT_THAT(file.complaints, ElementsAre()) << name;
    ASSERT_EQ(file.scene.points.size(), 200U) << name;
    ASSERT_EQ(file.scene.labels.size(), 200U) << name;
    for (std::size_t i = 0; i < 200; ++i) {
      expect_same(file.scene.points[i].place, expected.scene.points[i].place, name);
      EXPECT_EQ(file.scene.labels[i].text, fmt::format("p{}", i)) << name;
      EXPECT_EQ(file.scene.points[i].of.id, ObjectId{i + 1}) << name;
      EXPECT_EQ(file.scene.points[i].heights, HeightMode::clamp_to_ground) << name;
    }
  }
}

TEST_F(VectorObjects, AreasOverTheDateLineAndThePoleKeepTheirPositions) {
  const fs::path source = write(
      "areas.geojson",
      R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":
      [[[170,-10],[-170,-10],[-170,10],[170,10],[170,-10]],[[175,-1],[175,1],[-178,1],[175,-1]]]}},
      {"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[0,80],[90,81],[180,82],[-90,83],[0,80]]]}}]})");
  const ObjectFile expected = good(source);
  ASSERT_EQ(expected.scene.polygons.size(), 2U);
  const std::vector<std::pair<std::string, std::string>> files{{"a.gpkg", "-f GPKG"},
                                                               {"a.fgb", "-f FlatGeobuf -lco SPATIAL_INDEX=NO"}};
  for (const auto& [name, options] : files) {
    const ObjectFile file = good(convert(source, name, options));
    ASSERT_EQ(file.scene.polygons.size(), 2U) << name;
    for (std::size_t i = 0; i < 2; ++i) {
      ASSERT_EQ(file.scene.polygons[i].rings.size(), expected.scene.polygons[i].rings.size()) << name;
      for (std::size_t k = 0; k < file.scene.polygons[i].rings.size(); ++k) {
        expect_same(file.scene.polygons[i].rings[k], expected.scene.polygons[i].rings[k], name);
      }
    }
  }
  const ObjectFile polar = good(convert(source, "polar.gpkg", "-f GPKG -where 'FID=1' -t_srs EPSG:3413"));
  ASSERT_EQ(polar.scene.polygons.size(), 1U);
  expect_same(polar.scene.polygons[0].rings[0], expected.scene.polygons[1].rings[0], "polar");
}

std::string kml(const std::string& inside) {
  return R"(<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2"><Document>)" + inside +
         "</Document></kml>";
}

/// Height of the geoid EGM96 over the ellipsoid at a node of PROJ's grid, every 0.25 degrees, as the file stores it:
/// big-endian, a header of 40 bytes, rows from the south, columns from -180 degrees.
double geoid_m(const Geodetic& node) {
  constexpr int kColumns = 1440, kHeaderBytes = 40;
  std::ifstream grid("/usr/share/proj/egm96_15.gtx", std::ios::binary);
  const auto at = std::lround((node.lat.deg() + 90.0) * 4.0) * kColumns + std::lround((node.lon.deg() + 180.0) * 4.0);
  std::array<unsigned char, 4> bytes{};
  grid.seekg(kHeaderBytes + 4 * at).read(reinterpret_cast<char*>(bytes.data()), 4);
  EXPECT_TRUE(grid);
  return std::bit_cast<float>(std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
                              std::uint32_t{bytes[2]} << 8 | std::uint32_t{bytes[3]});
}

TEST_F(VectorObjects, HeightsOverTheSeaOfACompoundSystemAreOverTheEllipsoid) {
  const fs::path flat = write("h.geojson", R"({"type":"Feature","properties":{},"geometry":)"
                                           R"({"type":"Point","coordinates":[10,47,500]}})");
  const ObjectFile file = good(convert(flat, "h.gpkg", "-a_srs EPSG:4326+5773 -nlt POINTZ"));
  ASSERT_EQ(file.scene.points.size(), 1U);
  const Geodetic& place = file.scene.points[0].place;
  EXPECT_NEAR(place.height_m, 500.0 + geoid_m(place), 1e-3);
  EXPECT_GT(geoid_m(place), 40.0);
}

TEST_F(VectorObjects, KmlKeepsItsSharedStylesAndItsHeights) {
  const ObjectFile file =
      good(write("s.kml", kml(R"(<Style id="a"><LineStyle><color>7f0000ff</color><width>6</width></LineStyle>
      <PolyStyle><color>ff00ff00</color></PolyStyle></Style>
      <Placemark><name>L</name><styleUrl>#a</styleUrl><LineString><altitudeMode>absolute</altitudeMode>
      <coordinates>-30,0,100 30,20,100</coordinates></LineString></Placemark>
      <Placemark><name>P</name><Point><coordinates>5,5,7</coordinates></Point></Placemark>
      <Placemark><styleUrl>#a</styleUrl><Polygon><outerBoundaryIs><LinearRing>
      <coordinates>1,1 2,1 2,2 1,1</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark>)")));
  ASSERT_EQ(file.scene.lines.size(), 1U);
  const LineObject& line = file.scene.lines[0];
  EXPECT_EQ(line.width_px, 6.0F);
  EXPECT_EQ(line.color, (ObjectColor{255, 0, 0, 127}));
  EXPECT_EQ(line.heights, HeightMode::absolute);
  for (const Geodetic& place : line.places) EXPECT_NEAR(place.height_m, 100.0 + geoid_m(place), 1e-3);
  EXPECT_THAT(file.complaints, ElementsAre());
  EXPECT_EQ(file.scene.points.at(0).heights, HeightMode::clamp_to_ground);
  EXPECT_EQ(file.scene.polygons.at(0).fill, (ObjectColor{0, 255, 0, 255}));
}

TEST_F(VectorObjects, PointsOfKmlHaveTheColourAndTheScaleOfTheirIcon) {
  std::string places;
  for (const char* scale : {"0.5", "1", "2"}) {
    places += fmt::format(R"(<Placemark><Style><IconStyle><color>ff00ffff</color><scale>{}</scale></IconStyle></Style>
      <Point><coordinates>5,5</coordinates></Point></Placemark>)",
                          scale);
  }
  const ObjectFile file = good(write("i.kml", kml(places)));
  ASSERT_EQ(file.scene.points.size(), 3U);
  EXPECT_EQ(file.scene.points[0].color, (ObjectColor{255, 255, 0}));
  EXPECT_EQ(file.scene.points[0].size_px, 7.0F);
  EXPECT_EQ(file.scene.points[1].size_px, 10.0F);
  EXPECT_EQ(file.scene.points[2].size_px, 14.0F);
}

// 2009-02-13T23:31:30Z is 1,234,567,890 s after 1970, and 2001-09-09T01:46:40Z is 1,000,000,000.
TEST_F(VectorObjects, KmlKeepsItsTimes) {
  const std::string point = "<Point><coordinates>5,5</coordinates></Point></Placemark>";
  const ObjectFile file = good(write(
      "t.kml",
      kml("<Placemark><TimeSpan><begin>2001-09-09T01:46:40Z</begin><end>2009-02-14T00:31:30+01:00</end></TimeSpan>" +
          point + "<Placemark><TimeStamp><when>2009-02-13T23:31:30Z</when></TimeStamp>" + point + "<Placemark>" +
          point)));
  const auto at = [](int seconds) { return UtcTime(std::chrono::seconds(seconds)); };
  EXPECT_THAT(file.complaints, ElementsAre());
  ASSERT_EQ(file.shown_when.size(), 2U);
  EXPECT_EQ(file.shown_when[0].id, ObjectId{1});
  EXPECT_EQ(file.shown_when[0].from, at(1'000'000'000));
  EXPECT_EQ(file.shown_when[0].before, at(1'234'567'890));
  EXPECT_EQ(file.shown_when[1].from, at(1'234'567'890));
  EXPECT_FALSE(file.shown_when[1].before);
}

TEST_F(VectorObjects, LinksOfKmlAreNamedAndItsPicturesCounted) {
  const ObjectFile file =
      good(write("n.kml", kml(R"(<Placemark><Point><coordinates>5,5</coordinates></Point></Placemark>
      <NetworkLink><name>N</name><Link><href>http://127.0.0.1:9/y.kml</href></Link></NetworkLink>
      <GroundOverlay><name>G</name><Icon><href>x.png</href></Icon><LatLonBox><north>10</north><south>0</south>
      <east>60</east><west>50</west></LatLonBox></GroundOverlay>)")));
  EXPECT_EQ(file.scene.points.size(), 1U);
  EXPECT_EQ(file.scene.polygons.size(), 0U);
  EXPECT_THAT(file.complaints, Contains(HasSubstr("NetworkLink")));
  EXPECT_EQ(file.ground_overlays, 1U);
}

TEST_F(VectorObjects, MetresWithoutACoordinateSystemAreRefused) {
  const fs::path source = write("m.csv", "name,x,y\nA,465000,5240000\n");
  const auto file = read_objects(source);
  ASSERT_FALSE(file);
  EXPECT_THAT(file.error().message, HasSubstr("m.csv"));
  EXPECT_THAT(file.error().message, HasSubstr("coordinate system"));
}

TEST_F(VectorObjects, FilesThatAreNotWhatTheirNamesSayAreRefusedByName) {
  for (const char* name : {"a.kml", "a.kmz", "a.gpx", "a.shp", "a.fgb", "a.gpkg", "a.zip"}) {
    const auto file = read_objects(write(name, "<html>no map</html>"));
    ASSERT_FALSE(file) << name;
    EXPECT_THAT(file.error().message, HasSubstr(name));
  }
  EXPECT_FALSE(read_objects("/vsicurl/http://127.0.0.1:9/a.kml"));
  const auto link = read_objects(write("v.gpkg",
                                       "<OGRVRTDataSource><OGRVRTLayer name=\"a\"><SrcDataSource>/etc/passwd"
                                       "</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>"));
  EXPECT_FALSE(link);
}

std::string mutated(std::string bytes, std::mt19937& random) {
  const auto below = [&random](std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
  };
  for (std::size_t i = 0, changes = 1 + below(4); i < changes; ++i)
    bytes[below(bytes.size())] = static_cast<char>(below(256));
  if (below(4) == 0) bytes.resize(1 + below(bytes.size()));
  return bytes;
}

TEST_F(VectorObjects, TwoThousandBrokenFilesAreReadOrRefused) {
  const fs::path source = write("points.geojson", points(3, 6.0, 45.0, 5.0));
  const std::vector<std::pair<std::string, std::string>> files{
      {"a.kml", "-f LIBKML"},          {"a.kmz", "-f LIBKML"}, {"a.gpx", "-f GPX -nln waypoints -select name"},
      {"a.fgb", "-f FlatGeobuf"},      {"a.gpkg", "-f GPKG"},  {"a.csv", "-f CSV -lco GEOMETRY=AS_XY"},
      {"a.shp", "-f 'ESRI Shapefile'"}};
  std::mt19937 random(2000);
  constexpr int kEach = 290;
  for (const auto& [name, options] : files) {
    const fs::path path = convert(source, name, options);
    std::ifstream stream(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    for (int i = 0; i < kEach; ++i) {
      const auto file = read_objects(write(name, mutated(bytes, random)));
      EXPECT_THAT(file ? name : file.error().message, HasSubstr(name));
    }
  }
}

}  // namespace
}  // namespace terrella
