#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "apps/serve/descriptions.h"
#include "geo/body.h"
#include "streaming/georeference/crs.h"
#include "streaming/remote/crs_names.h"
#include "streaming/remote/wmts/wmts.h"
#include "tests/serve/served_tiles.h"

namespace terrella {
namespace {

constexpr const char* kServer = "http://127.0.0.1:8080";
/// A thousandth of a pixel of the finest tiles below.
constexpr double kPlaceDeg = 1e-5;

ServedSet served(const TileSetInfo& info, const char* name = "set") {
  return {.name = name, .tiles = std::make_shared<test::NamedTiles>(info)};
}

RemoteTileSet read_back(const TileSetInfo& info) {
  const auto xml = wmts_capabilities(std::vector{served(info)}, kServer);
  EXPECT_TRUE(xml.ok()) << (xml ? "" : xml.error().message);
  auto set = parse_wmts_capabilities(*xml, {}, "test");
  EXPECT_TRUE(set.ok()) << (set ? "" : set.error().message);
  return set ? *std::move(set) : RemoteTileSet{};
}

void expect_same_grid(const TileGrid& read, const TileGrid& made) {
  EXPECT_EQ(read.projection, made.projection);
  EXPECT_EQ(read.tile_px, made.tile_px);
  EXPECT_EQ(read.max_level - read.min_level, made.max_level - made.min_level);
  EXPECT_NEAR(tile_span_deg(read, read.max_level), tile_span_deg(made, made.max_level), kPlaceDeg);
  EXPECT_NEAR(read.bounds.west.deg(), made.bounds.west.deg(), kPlaceDeg);
  EXPECT_NEAR(read.bounds.east.deg(), made.bounds.east.deg(), kPlaceDeg);
}

TEST(WmtsCapabilities, DescribeTheGridsThatTerrellaReads) {
  std::vector<TileSetInfo> infos{test::geodetic_info(), test::geodetic_info(), test::web_info(), test::geodetic_info()};
  infos[1].grid.root_span_deg = 288.0;
  infos[1].grid.tile_px = 512;
  infos[3].body = "moon";
  infos[3].grid.min_level = 1;
  for (const TileSetInfo& info : infos) {
    const RemoteTileSet set = read_back(info);
    expect_same_grid(set.info.grid, info.grid);
    EXPECT_EQ(set.info.body, info.body.empty() ? "earth" : info.body);
    EXPECT_EQ(set.info.format, ImageFormat::png);
  }
}

TEST(WmtsCapabilities, NameLevelsByTheZoomOfAddresses) {
  TileSetInfo info = test::web_info();
  info.grid.root_span_deg = 90.0;  // 4 columns: zoom 2
  const auto xml = wmts_capabilities(std::vector{served(info)}, kServer);
  ASSERT_TRUE(xml.ok());
  for (const char* zoom : {"2", "3", "4", "5"}) {
    EXPECT_NE(xml->find(fmt::format("<TileMatrix><ows:Identifier>{}<", zoom)), std::string::npos) << zoom;
  }
}

TEST(WmtsCapabilities, DescribeProjectedSets) {
  TileSetInfo info = test::geodetic_info();
  info.grid.projection = Projection::projected;
  info.grid.root_span_deg = 360.0;
  for (const char* crs : {"EPSG:25832", "EPSG:3035"}) {  // easting first, northing first
    info.square = CrsSquare{.crs = crs, .west = 4e5, .north = 3e6, .unit_per_deg = 1000.0};
    const RemoteTileSet set = read_back(info);
    ASSERT_TRUE(set.info.square.has_value());
    EXPECT_NEAR(set.info.square->west, 4e5, 0.01);
    EXPECT_NEAR(set.info.square->north, 3e6, 0.01);
    EXPECT_NEAR(set.info.square->unit_per_deg, 1000.0, 1e-5);
  }
}

TEST(WmtsCapabilities, HaveTheBoundsOfProjectedSets) {
  TileSetInfo info = test::geodetic_info();
  info.grid.projection = Projection::projected;
  info.grid.root_span_deg = 360.0;
  // From 400 to 760 km east and from 2640 to 3000 km north in UTM zone 32, whose meridian is 9° E: longitudes from 8.0
  // to 11.6 and latitudes from 23.8 to 27.2.
  info.square = CrsSquare{.crs = "EPSG:25832", .west = 4e5, .north = 3e6, .unit_per_deg = 1000.0};
  constexpr double kMarginDeg = 1.0;  // the drawn grid is rounded to its tiles
  const std::string xml = *wmts_capabilities(std::vector{served(info)}, kServer);
  const auto corner = [&xml](const std::string& name) {
    char* rest = nullptr;
    const double x = std::strtod(xml.c_str() + xml.find(name) + name.size(), &rest);
    return std::pair(x, std::strtod(rest, nullptr));
  };
  const auto [west, south] = corner("<ows:LowerCorner>");
  const auto [east, north] = corner("<ows:UpperCorner>");
  EXPECT_NEAR(west, 8.0, kMarginDeg);
  EXPECT_NEAR(south, 23.8, kMarginDeg);
  EXPECT_NEAR(east, 11.6, kMarginDeg);
  EXPECT_NEAR(north, 27.2, kMarginDeg);
}

TEST(WmtsCapabilities, NameSystemsThatProjOpens) {
  int named = 0;
  for (const char* body : {"", "earth", "mercury", "venus", "moon", "phobos", "mars", "jupiter", "saturn"}) {
    for (const LatitudeKind latitude : {LatitudeKind::graphic, LatitudeKind::centric}) {
      const std::string urn = geographic_crs_urn(body, latitude);
      if (urn.empty()) continue;
      ++named;
      const auto crs = Crs::open(urn);
      EXPECT_TRUE(crs.ok()) << urn << (crs ? "" : ": " + crs.error().message);
      const auto parsed = parse_crs(urn);
      ASSERT_TRUE(parsed.ok()) << urn;
      if (parse_body(parsed->body)->ellipsoid.f() > 0.0) {
        EXPECT_EQ(parsed->latitude, latitude) << urn;
      }
    }
  }
  EXPECT_GE(named, 10);
}

TEST(Descriptions, OfWebMercatorAreOfTheEarth) {
  TileSetInfo info = test::web_info();
  for (const char* body : {"mars", "moon", "venus", "1000000,0"}) {
    info.body = body;
    const auto xml = wmts_capabilities(std::vector{served(info)}, kServer), json = tile_json(served(info), kServer);
    ASSERT_FALSE(xml.ok()) << body;
    EXPECT_NE(xml.error().message.find("XYZ"), std::string::npos);
    ASSERT_FALSE(json.ok()) << body;
    EXPECT_NE(json.error().message.find("XYZ"), std::string::npos);
    const std::string addresses = addresses_json(std::vector{served(info)}, kServer, 1);
    EXPECT_EQ(addresses.find("tilejson"), std::string::npos);
    EXPECT_EQ(addresses.find("wmts"), std::string::npos);
  }
  for (const char* body : {"", "earth", "sphere"}) {
    info.body = body;
    EXPECT_TRUE(wmts_capabilities(std::vector{served(info)}, kServer).ok()) << body;
    EXPECT_TRUE(tile_json(served(info), kServer).ok()) << body;
  }
}

TEST(Descriptions, SayThatTilesAreNumbers) {
  TileSetInfo info = test::web_info();
  info.numbers = NumberInfo{.scale = 0.1, .offset = -10000.0, .rgb = true, .unit = "m", .quantity = "height"};
  const std::string note =
      "The tiles are numbers, not pictures: height = 0.1 * (R * 65536 + G * 256 + B) + -10000, in m";
  const std::vector sets{served(info)};
  for (const std::string& document :
       {*wmts_capabilities(sets, kServer), *tile_json(sets[0], kServer), overview_page(sets, kServer)}) {
    EXPECT_NE(document.find(note), std::string::npos) << document;
  }
  info.numbers.reset();
  EXPECT_EQ(wmts_capabilities(std::vector{served(info)}, kServer)->find("Abstract"), std::string::npos);
}

TEST(WmtsCapabilities, RefuseWhatNoSystemDescribes) {
  TileSetInfo info = test::geodetic_info();
  info.grid.projection = Projection::equal_area;
  const auto xml = wmts_capabilities(std::vector{served(info)}, kServer);
  ASSERT_FALSE(xml.ok());
  EXPECT_NE(xml.error().message.find("XYZ"), std::string::npos);
}

TEST(TileJson, DescribesWebMercatorAlone) {
  EXPECT_FALSE(tile_json(served(test::geodetic_info()), kServer).ok());
  TileSetInfo info = test::web_info();
  info.attribution = "a \"b\" <c> \xFF";
  info.grid.root_span_deg = 90.0;
  const auto json = nlohmann::json::parse(*tile_json(served(info), kServer));
  EXPECT_EQ(json["tiles"][0], "http://127.0.0.1:8080/set/{z}/{x}/{y}.png");
  EXPECT_EQ(json["minzoom"], 2);
  EXPECT_EQ(json["maxzoom"], 5);
  EXPECT_EQ(json["attribution"], "a \"b\" <c> \xEF\xBF\xBD");
  EXPECT_NEAR(json["bounds"][3].get<double>(), kMercatorEndDeg, kPlaceDeg);
}

TEST(Descriptions, EscapeTextsOfTheSets) {
  TileSetInfo info = test::geodetic_info();
  info.name = "<script>alert(1)</script>&\"\x1B";
  info.attribution = info.name;
  const std::vector sets{served(info)};
  for (const std::string& document : {overview_page(sets, kServer), *wmts_capabilities(sets, kServer)}) {
    EXPECT_EQ(document.find("<script"), std::string::npos);
    EXPECT_EQ(document.find('\x1B'), std::string::npos);
    EXPECT_NE(document.find("&lt;script&gt;alert(1)&lt;/script&gt;&amp;&quot;"), std::string::npos);
  }
}

TEST(OverviewPage, ShowsTheCoarsestTilesFromThisServer) {
  const std::string page = overview_page(std::vector{served(test::geodetic_info())}, kServer);
  EXPECT_NE(page.find("src=\"http://127.0.0.1:8080/set/0/1/0.png\""), std::string::npos);
  EXPECT_EQ(page.find("/set/0/2/0.png"), std::string::npos);
  for (std::size_t at = page.find("://"); at != page.npos; at = page.find("://", at + 1)) {
    EXPECT_EQ(page.substr(at - 4, 21), kServer);
  }
}

}  // namespace
}  // namespace terrella
