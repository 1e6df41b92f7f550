#include "streaming/remote/wmts/wmts.h"

#include <gtest/gtest.h>

#include <regex>

#include "streaming/remote/wmts/ogc_choices.h"
#include "wmts_documents.h"

namespace terrella {
namespace {

using test::capabilities;
using test::gibs_set;
using test::LayerText;
using test::MatrixSetText;
using test::quads;

RemoteTileSet read(const std::string& xml, const RemoteOptions& options = {}) {
  auto set = parse_wmts_capabilities(xml, options, "caps");
  EXPECT_TRUE(set) << set.error().message;
  return set ? *std::move(set) : RemoteTileSet{};
}

std::string refusal(const std::string& xml, const RemoteOptions& options = {}) {
  const auto set = parse_wmts_capabilities(xml, options, "caps");
  EXPECT_FALSE(set);
  if (set) return {};
  EXPECT_TRUE(set.error().message.starts_with("caps: ")) << set.error().message;
  return set.error().message;
}

void expect_wmts_refused(const std::string& xml, const std::string& why, const RemoteOptions& options = {}) {
  const std::string said = refusal(xml, options);
  EXPECT_NE(said.find(why), std::string::npos) << said;
}

std::string one_set(MatrixSetText set, const LayerText& like = {}) {
  LayerText layer = like;
  set.name = "set";
  layer.matrix_sets = {"set"};
  return capabilities({layer}, {set});
}

constexpr double kSpanSlack = 1e-13;  // relative: a few roundings of doubles

TEST(Wmts, GibsSetsAre288DegreesHalvedAndClippedToThePlanet) {
  for (const std::size_t levels : {3UL, 8UL, 9UL, 13UL}) {
    const MatrixSetText text = gibs_set("set", levels);
    const RemoteTileSet set = read(one_set(text));
    const TileGrid& grid = set.info.grid;
    EXPECT_NEAR(grid.root_span_deg, 288.0, 288.0 * kSpanSlack);
    EXPECT_EQ(grid.tile_px, 512);
    EXPECT_EQ(grid.min_level, 0);
    ASSERT_EQ(grid.max_level, static_cast<int>(levels) - 1);
    for (int level = 0; level <= grid.max_level; ++level) {
      const auto [width, height] = text.sizes[static_cast<std::size_t>(level)];
      EXPECT_EQ(columns(grid, level), width) << level;
      EXPECT_EQ(rows(grid, level), height) << level;
      for (const TileId id : {TileId{level, 0, 0}, TileId{level, width - 1, 0}, TileId{level, 0, height - 1},
                              TileId{level, width - 1, height - 1}}) {
        EXPECT_TRUE(exists(grid, id));
        EXPECT_EQ(tile_url(set, id),
                  fmt::format("https://example.com/wmts/layer/default/set/{}/{}/{}.jpg", level, id.y, id.x));
      }
    }
  }
}

TEST(Wmts, ADocumentOfGibsFormGivesItsLayers) {
  const RemoteTileSet still = read(test::gibs_document(), {.layer = "Still"});
  EXPECT_EQ(tile_url(still, {2, 4, 2}), "https://example.com/wmts/epsg4326/best/Still/default/500m/2/2/4.jpeg");
  EXPECT_EQ(still.info.name, "About Still");
  EXPECT_EQ(still.info.attribution, "Provider");
  EXPECT_EQ(still.info.body, "earth");
  EXPECT_EQ(still.info.format, ImageFormat::jpeg);
  EXPECT_FALSE(still.missing_life);
  const RemoteTileSet daily = read(test::gibs_document(), {.layer = "Daily"});
  EXPECT_EQ(tile_url(daily, {0, 1, 0}),
            "https://example.com/wmts/epsg4326/best/Daily/default/2024-05-20/250m/0/0/1.png");
  EXPECT_EQ(daily.info.format, ImageFormat::png);
  EXPECT_EQ(daily.missing_life, std::chrono::hours(1));
}

TEST(Wmts, TimesAreThoseThatAreListed) {
  const auto with_time = [](const std::string& time) { return RemoteOptions{.layer = "Daily", .time = time}; };
  const RemoteTileSet old = read(test::gibs_document(), with_time("2012-07-09"));
  EXPECT_NE(tile_url(old, {}).with_secrets().find("/2012-07-09/"), std::string::npos) << old.url.redacted();
  EXPECT_FALSE(old.missing_life);
  EXPECT_EQ(old.info.time, "2012-07-09");
  EXPECT_EQ(old.info.times, "2000-02-24 to 2024-05-20: 8822 instants, P1D, 1 gap") << "by the calendar";
  EXPECT_EQ(old.info.steps->count(), 8822);
  const RemoteTileSet noon = read(test::gibs_document(), with_time("2012-07-09T12:30:00Z"));
  EXPECT_NE(tile_url(noon, {}).with_secrets().find("/2012-07-09T12:30:00Z/"), std::string::npos);
  for (const char* time : {"1999-01-01", "2021-01-15", "2024-05-21", "yesterday", "2012-02-30", "2012-7-9", "{z}"}) {
    expect_wmts_refused(test::gibs_document(), "2000-02-24/2020-12-31/P1D", with_time(time));
  }
  expect_wmts_refused(test::gibs_document(), "no time dimension", {.layer = "Still", .time = "2012-07-09"});
}

TEST(Wmts, FindsTheQuadtreesOfTheStandard) {
  const RemoteTileSet quad = read(one_set({.denominator = test::kCrs84QuadDenominator, .sizes = quads(2, 1, 18)}));
  EXPECT_NEAR(quad.info.grid.root_span_deg, 180.0, 180.0 * kSpanSlack);
  EXPECT_EQ(quad.info.grid.max_level, 17);
  const RemoteTileSet google =
      read(one_set({.denominator = 2 * test::kCrs84QuadDenominator, .sizes = {{1, 1}, {2, 1}, {4, 2}}}));
  EXPECT_NEAR(google.info.grid.root_span_deg, 360.0, 360.0 * kSpanSlack);
}

TEST(Wmts, ACornerMayBeWholeTilesAway) {
  // GoogleCRS84Quad as OGC 07-057r7 has it: 90° of nothing above the north pole.
  const RemoteTileSet set =
      read(one_set({.denominator = 2 * test::kCrs84QuadDenominator, .sizes = quads(1, 1, 5), .corner = "-180 180"}));
  EXPECT_EQ(set.info.grid.min_level, 2);
  EXPECT_EQ(tile_url(set, {2, 3, 0}), "https://example.com/wmts/layer/default/set/2/1/3.jpg");
  EXPECT_EQ(tile_url(set, {3, 0, 3}), "https://example.com/wmts/layer/default/set/3/5/0.jpg");
  const RemoteTileSet from_0 =
      read(one_set({.denominator = test::kCrs84QuadDenominator, .sizes = quads(2, 1, 3), .corner = "0 90"}));
  EXPECT_EQ(tile_url(from_0, {1, 0, 1}), "https://example.com/wmts/layer/default/set/1/1/2.jpg");
  EXPECT_EQ(tile_url(from_0, {1, 2, 0}), "https://example.com/wmts/layer/default/set/1/0/0.jpg");
}

TEST(Wmts, LatitudeMayComeFirst) {
  for (const char* crs : {"urn:ogc:def:crs:EPSG::4326", "EPSG:4326", "urn:ogc:def:crs:EPSG:6.18:3:4326",
                          "http://www.opengis.net/def/crs/EPSG/0/4326", "OGC:CRS84", "urn:ogc:def:crs:OGC:2:84"}) {
    for (const char* corner : {"90 -180", "-180 90", " 90.0\n-180.0 "}) {
      const RemoteTileSet set = read(
          one_set({.crs = crs, .denominator = test::kCrs84QuadDenominator, .sizes = quads(2, 1, 3), .corner = corner}));
      EXPECT_TRUE(set.shifts.empty()) << crs << corner;
      EXPECT_EQ(set.info.grid.max_level, 2);
    }
  }
}

TEST(Wmts, OtherBodiesCountWithEarthsRadiusOrTheirOwn) {
  constexpr double kMars = 3396190.0 / 6378137.0;
  constexpr double kMoon = 1737400.0 / 6378137.0;
  for (const auto& [crs, body, scale] : {std::tuple("urn:ogc:def:crs:EPSG::104905", "mars", kMars),
                                         std::tuple("urn:ogc:def:crs:IAU2000::49900", "mars", 1.0),
                                         std::tuple("urn:ogc:def:crs:IAU:2015:30100", "moon", kMoon)}) {
    const RemoteTileSet set =
        read(one_set({.crs = crs, .denominator = test::kCrs84QuadDenominator * scale, .sizes = quads(2, 1, 8)}));
    EXPECT_NEAR(set.info.grid.root_span_deg, 180.0, 180.0 * kSpanSlack) << crs;
    EXPECT_EQ(set.info.body, body);
  }
  // CRS84 of a body that only a person can name.
  const std::string mars = one_set({.denominator = test::kCrs84QuadDenominator * kMars, .sizes = quads(2, 1, 8)});
  EXPECT_NEAR(read(mars, {.body = "mars"}).info.grid.root_span_deg, 180.0, 180.0 * kSpanSlack);
  const RemoteTileSet centric =
      read(one_set({.crs = "IAU_2015:49902", .denominator = test::kCrs84QuadDenominator, .sizes = quads(2, 1, 2)}));
  EXPECT_EQ(centric.info.grid.latitude, LatitudeKind::centric);
}

TEST(Wmts, RefusesSetsThatNoRootSpanDescribes) {
  const auto like = [](MatrixSetText set) {
    if (set.denominator == 0.0) set.denominator = test::kCrs84QuadDenominator;
    if (set.sizes.empty()) set.sizes = quads(2, 1, 3);
    return one_set(set);
  };
  expect_wmts_refused(like({.crs = "urn:ogc:def:crs:EPSG::3857"}), "must begin at (-20037508.34, 20037508.34)");
  expect_wmts_refused(like({.crs = "urn:ogc:def:crs:EPSG:6.18:3:900913"}), "not at (-180, 90)");
  expect_wmts_refused(like({.corner = "-170 90"}), "no whole number of tiles");
  expect_wmts_refused(like({.crs = "urn:ogc:def:crs:EPSG::104905", .ratio = 2.5}), "do not halve");
  expect_wmts_refused(like({.corner = "west north"}), "TopLeftCorner");
  expect_wmts_refused(like({.denominator = -1.0}), "ScaleDenominator");
  expect_wmts_refused(like({.tile_px = 7}), "TileWidth");
  expect_wmts_refused(like({.denominator = 1e6, .sizes = {{560, 280}}}), "root tiles");
}

TEST(Wmts, TakesTheFirstSetThatCanBeShown) {
  const MatrixSetText mercator{.name = "GoogleMapsCompatible",
                               .crs = "EPSG:3857",
                               .denominator = 559082264.0287178,
                               .sizes = quads(1, 1, 22),
                               .corner = "-20037508.34 20037508.34"};
  const MatrixSetText quad{
      .name = "WorldCRS84Quad", .denominator = test::kCrs84QuadDenominator, .sizes = quads(2, 1, 2)};
  const std::string xml = capabilities({{.matrix_sets = {"GoogleMapsCompatible", "WorldCRS84Quad"}}}, {mercator, quad});
  EXPECT_NE(read(xml).url.with_secrets().find("WorldCRS84Quad"), std::string::npos);
  for (const RemoteOptions& options :
       {RemoteOptions{.matrix_set = "GoogleMapsCompatible"}, RemoteOptions{.projection = Projection::web_mercator}}) {
    const RemoteTileSet web = read(xml, options);
    EXPECT_NE(web.url.with_secrets().find("GoogleMapsCompatible"), std::string::npos);
    EXPECT_EQ(web.info.grid.projection, Projection::web_mercator);
    EXPECT_EQ(web.info.grid.root_span_deg, 360.0);
    EXPECT_EQ(web.info.grid.max_level, 21);
    EXPECT_TRUE(web.shifts.empty());
  }
  const std::string geodetic = capabilities({{.matrix_sets = {"WorldCRS84Quad"}}}, {quad});
  expect_wmts_refused(geodetic, "not in Web Mercator as was given", {.projection = Projection::web_mercator});
  expect_wmts_refused(xml, "GoogleMapsCompatible, WorldCRS84Quad", {.matrix_set = "Nothing"});
}

TEST(Wmts, LimitsAndBoxesNarrowLevelsAndBounds) {
  // Some servers name the set too.
  for (const std::string prefix : {"", "wrap:"}) {
    const auto limit = [&prefix](int matrix, int row0, int row1, int col0, int col1) {
      return fmt::format(
          "<TileMatrixLimits><TileMatrix>{}</TileMatrix><MinTileRow>{}</MinTileRow><MaxTileRow>{}</MaxTileRow>"
          "<MinTileCol>{}</MinTileCol><MaxTileCol>{}</MaxTileCol></TileMatrixLimits>",
          prefix + std::to_string(matrix), row0, row1, col0, col1);
    };
    const LayerText limited{
        .more =
            "<ows:WGS84BoundingBox><ows:LowerCorner>-80 -90</ows:LowerCorner><ows:UpperCorner>180 "
            "40</ows:UpperCorner></ows:WGS84BoundingBox>",
        .limits = "<TileMatrixSetLimits>" + limit(1, 0, 1, 0, 1) + limit(2, 1, 2, 2, 3) + "</TileMatrixSetLimits>"};
    const RemoteTileSet set =
        read(one_set({.denominator = test::kCrs84QuadDenominator, .sizes = quads(2, 1, 6)}, limited));
    EXPECT_EQ(set.info.grid.min_level, 1);
    EXPECT_EQ(set.info.grid.max_level, 2);
    constexpr double kRoundingDeg = 1e-12;
    EXPECT_NEAR(set.info.grid.bounds.west.deg(), -80.0, kRoundingDeg);
    EXPECT_NEAR(set.info.grid.bounds.east.deg(), 0.0, kRoundingDeg);
    EXPECT_NEAR(set.info.grid.bounds.north.deg(), 40.0, kRoundingDeg);
    EXPECT_NEAR(set.info.grid.bounds.south.deg(), -45.0, kRoundingDeg);
  }
}

// Servers of Mars imagery write them so.
TEST(Wmts, WidthsOfMatricesMayBeWrittenAsDecimals) {
  const std::string xml = one_set({.denominator = test::kCrs84QuadDenominator, .sizes = quads(2, 1, 3)});
  const auto with = [&xml](const std::string& width) {
    return std::regex_replace(xml, std::regex("<MatrixWidth>(\\d+)<"), "<MatrixWidth>" + width + "<");
  };
  EXPECT_EQ(read(with("$1.0")).info.grid, read(xml).info.grid);
  expect_wmts_refused(with("$1.5"), "MatrixWidth");
}

TEST(Wmts, AsksWithKeysAndValuesWhereThereIsNoTemplate) {
  const std::string operations =
      "<ows:OperationsMetadata><ows:Operation name=\"GetCapabilities\"/><ows:Operation "
      "name=\"GetTile\"><ows:DCP><ows:HTTP>"
      "<ows:Get xlink:href=\"https://example.com/rest/\"><ows:Constraint name=\"GetEncoding\"><ows:AllowedValues>"
      "<ows:Value>RESTful</ows:Value></ows:AllowedValues></ows:Constraint></ows:Get>"
      "<ows:Get xlink:href=\"https://example.com/wmts.cgi?map=a&amp;\"><ows:Constraint "
      "name=\"GetEncoding\"><ows:AllowedValues>"
      "<ows:Value>KVP</ows:Value></ows:AllowedValues></ows:Constraint></ows:Get></ows:HTTP></ows:DCP></ows:Operation></"
      "ows:OperationsMetadata>";
  const std::string xml = capabilities(
      {{.name = "a b&amp;{z}", .matrix_sets = {"set"}, .resources = {}}},
      {{.name = "set", .denominator = test::kCrs84QuadDenominator, .sizes = quads(2, 1, 3), .prefix = "EPSG:4326:"}},
      operations);
  EXPECT_EQ(tile_url(read(xml), {2, 7, 3}),
            "https://example.com/"
            "wmts.cgi?map=a&SERVICE=WMTS&REQUEST=GetTile&VERSION=1.0.0&LAYER=a%20b%26%7Bz%7D&STYLE=default"
            "&TILEMATRIXSET=set&FORMAT=image%2Fjpeg&TILEMATRIX=EPSG:4326:2&TILEROW=3&TILECOL=7");
  expect_wmts_refused(capabilities({{.matrix_sets = {"set"}, .resources = {}}}, {gibs_set("set", 3)}),
                      "neither a ResourceURL");
}

TEST(Wmts, SaysWhatThereIsInstead) {
  expect_wmts_refused(test::gibs_document(), "Still, Daily");
  expect_wmts_refused(test::gibs_document(), "Still, Daily", {.layer = "Other"});
  expect_wmts_refused(test::gibs_document(), "but \"Still\"", {.layer = "still"});
  expect_wmts_refused(test::gibs_document(), "no style \"x\"; it has: default", {.layer = "Still", .style = "x"});
  expect_wmts_refused(test::gibs_document(), "image/jpeg", {.layer = "Still", .format = ImageFormat::png});
  expect_wmts_refused(test::gibs_document(), "spans 288°", {.layer = "Still", .root_span_deg = 180.0});
  expect_wmts_refused(test::gibs_document(), "512 pixels", {.layer = "Still", .tile_px = 256});
  expect_wmts_refused(test::gibs_document(), "levels 0 to 7", {.layer = "Still", .min_level = 9});
  std::vector<LayerText> many;
  for (int i = 0; i < 1000; ++i) many.push_back({.name = fmt::format("l{}", i)});
  EXPECT_LT(refusal(capabilities(many, {})).size(), 500U);
}

TEST(Wmts, RefusesWhatIsNoCapabilities) {
  expect_wmts_refused("", "not XML");
  expect_wmts_refused("<html><body>Not found</body></html>", "not the capabilities");
  expect_wmts_refused("<WMS_Capabilities/>", "of a WMS");
  expect_wmts_refused(
      "<ExceptionReport><Exception><ExceptionText>no such map</ExceptionText></Exception></ExceptionReport>",
      "no such map");
  const LayerText odd{
      .resources =
          R"(<ResourceURL format="image/jpeg" resourceType="tile" template="https://example.com/{z}/{TileCol}/{TileRow}"/>)"};
  expect_wmts_refused(one_set(gibs_set("set", 3), odd), "unknown placeholder {z}");
  const LayerText scheme{
      .resources =
          R"(<ResourceURL format="image/jpeg" resourceType="tile" template="gopher://a/{TileMatrix}/{TileCol}/{TileRow}"/>)"};
  expect_wmts_refused(one_set(gibs_set("set", 3), scheme), "must begin with http");
  const std::string entity = "<!DOCTYPE a [<!ENTITY b SYSTEM \"file:///etc/passwd\">]>";
  std::string xml = one_set(gibs_set("set", 3), {.name = "&b;"});
  xml.insert(xml.find("<Capabilities"), entity);
  EXPECT_EQ(read(xml).info.name, "About &b;");
  expect_wmts_refused(std::string(kMaxCapabilitiesBytes + 1, ' '), "longer than");
}

}  // namespace
}  // namespace terrella
