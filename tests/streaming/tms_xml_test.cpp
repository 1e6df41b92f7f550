#include "streaming/sets/tms_xml.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace terrella {
namespace {

struct TmsText {
  std::string srs = "EPSG:4326";
  std::string format = R"(<TileFormat width="256" height="256" mime-type="image/png" extension="png"/>)";
  std::string levels =
      R"(<TileSet href="0" units-per-pixel="0.703125"/><TileSet href="1" units-per-pixel="0.3515625"/>)";
  std::string profile = "geodetic";

  [[nodiscard]] std::string text() const {
    return "<TileMap><Title>A planet</Title><SRS>" + srs +
           R"(</SRS><BoundingBox minx="-20" miny="-90.0000001" maxx="30" maxy="45"/>)" + format +
           "<TileSets profile=\"" + profile + "\">" + levels + "</TileSets></TileMap>";
  }
};

TmsDescription read(const TmsText& tms) {
  auto description = parse_tms_xml(tms.text(), "here");
  EXPECT_TRUE(description) << description.error().message;
  return description ? *std::move(description) : TmsDescription{};
}

void expect_tms_refused(const TmsText& tms, const std::string& says) {
  const auto description = parse_tms_xml(tms.text(), "here");
  ASSERT_FALSE(description) << tms.text();
  EXPECT_EQ(description.error().message.rfind("here: ", 0), 0U) << description.error().message;
  EXPECT_NE(description.error().message.find(says), std::string::npos) << description.error().message;
}

TEST(TmsXml, SaysWhatTheSetIs) {
  const TmsDescription tms = read({});
  EXPECT_EQ(tms.info.name, "A planet");
  EXPECT_EQ(tms.info.format, ImageFormat::png);
  EXPECT_EQ(tms.extension, "png");
  const GeoRect bounds{Angle::degrees(-20), Angle::degrees(-90), Angle::degrees(30), Angle::degrees(45)};
  EXPECT_EQ(tms.info.grid, (TileGrid{.root_span_deg = 180, .tile_px = 256, .max_level = 1, .bounds = bounds}));
  EXPECT_EQ(tms.folder, (std::map<int, std::string>{{0, "0"}, {1, "1"}}));
}

TEST(TmsXml, LevelsMayBeginAnywhereAndStandInAnyOrder) {
  const TmsDescription tms = read({.levels = R"(<TileSet href="b" units-per-pixel="0.17578125"/>
      <TileSet href="http://server/a" units-per-pixel="0.3515625"/>)"});
  EXPECT_EQ(tms.info.grid.min_level, 1);
  EXPECT_EQ(tms.info.grid.max_level, 2);
  EXPECT_DOUBLE_EQ(tms.info.grid.root_span_deg, 180.0);
  EXPECT_EQ(tms.folder, (std::map<int, std::string>{{1, "a"}, {2, "b"}}));
}

TEST(TmsXml, ARootTileOf360DegreesIsLeftOut) {
  // The root tile begins at -90° and would end at 270°: no tile of a grid that begins at +90°.
  const TmsDescription tms = read({.levels = R"(<TileSet href="0" units-per-pixel="1.40625"/>
      <TileSet href="1" units-per-pixel="0.703125"/>)"});
  EXPECT_DOUBLE_EQ(tile_span_deg(tms.info.grid, tms.info.grid.min_level), 180.0);
  EXPECT_EQ(tms.folder.begin()->second, "1");
}

TEST(TmsXml, OtherSpansThatDivideAHalfTurnAreTaken) {
  const TmsDescription tms = read({.levels = R"(<TileSet href="7" units-per-pixel="0.234375"/>)"});
  EXPECT_DOUBLE_EQ(tile_span_deg(tms.info.grid, tms.info.grid.min_level), 60.0);
  EXPECT_EQ(rows(tms.info.grid, tms.info.grid.min_level), 3);
}

TEST(TmsXml, RefusesWithTheReason) {
  expect_tms_refused({.srs = "EPSG:3857"}, "360° halved some times");
  expect_tms_refused({.profile = "mercator"}, "its <SRS> is EPSG:4326 and its profile \"mercator\"");
  expect_tms_refused({.srs = "EPSG:31467"}, "EPSG:31467");
  expect_tms_refused({.format = R"(<TileFormat width="256" height="128" extension="png"/>)"}, "TileFormat");
  expect_tms_refused({.format = R"(<TileFormat width="1e9" height="1e9" extension="png"/>)"}, "TileFormat");
  expect_tms_refused({.format = R"(<TileFormat width="256" height="256" extension="gif"/>)"}, "gif");
  expect_tms_refused({.levels = ""}, "no <TileSet>");
  expect_tms_refused({.levels = R"(<TileSet href="0" units-per-pixel="0"/>)"}, "units-per-pixel");
  expect_tms_refused({.levels = R"(<TileSet href="0" units-per-pixel="nan"/>)"}, "units-per-pixel");
  expect_tms_refused({.levels = R"(<TileSet href="0" units-per-pixel="0.7x"/>)"}, "units-per-pixel");
  expect_tms_refused({.levels = R"(<TileSet href=".." units-per-pixel="0.703125"/>)"}, "folder");
  expect_tms_refused({.levels = R"(<TileSet href="0" units-per-pixel="0.7"/>)"}, "divide 180°");
  expect_tms_refused(
      {.levels = R"(<TileSet href="0" units-per-pixel="0.9"/><TileSet href="1" units-per-pixel="0.3"/>)"}, "halve");
  std::string many;
  for (int i = 0; i < 100; ++i) many += R"(<TileSet href="0" units-per-pixel="0.7"/>)";
  expect_tms_refused({.levels = many}, "more than 64");
}

TEST(TmsXml, WhatIsNoTileMapIsRefused) {
  EXPECT_FALSE(parse_tms_xml("", "here"));
  EXPECT_FALSE(parse_tms_xml("<TileMap", "here"));
  EXPECT_FALSE(parse_tms_xml("<a/>", "here"));
  EXPECT_FALSE(parse_tms_xml(std::string(kMaxTmsXmlBytes + 1, ' '), "here"));
}

TEST(TmsXml, AnySystemBeginsAtItsOrigin) {
  const auto with = [](const std::string& srs, const std::string& origin, const std::string& levels) {
    return parse_tms_xml("<TileMap><SRS>" + srs + R"(</SRS><BoundingBox minx="0" miny="0" maxx="5000" maxy="3000"/>)" +
                             origin +
                             R"(<TileFormat width="256" height="256" extension="png"/><TileSets profile="raster">)" +
                             levels + "</TileSets></TileMap>",
                         "here");
  };
  const std::string origin = R"(<Origin x="-1000" y="-2000"/>)";
  const std::string levels = R"(<TileSet href="0" units-per-pixel="20"/><TileSet href="1" units-per-pixel="8"/>)";
  const auto tms = with("EPSG:3031", origin, levels);
  ASSERT_TRUE(tms) << tms.error().message;
  ASSERT_TRUE(tms->info.square);
  // 6000 by 5000 m in tiles of 5120 and 2048 m, rows from the south.
  const CrsLevel coarse{.west = -1000, .north = 3120, .unit_per_px = 20, .columns = 2, .rows = 1};
  const CrsLevel fine{.west = -1000, .north = 4144, .unit_per_px = 8, .columns = 3, .rows = 3};
  EXPECT_EQ(tms->info.square->levels, (std::vector{coarse, fine}));
  EXPECT_EQ(tms->folder, (std::map<int, std::string>{{0, "0"}, {1, "1"}}));
  const auto refusal = [&](const auto& read) { return read ? std::string("read") : read.error().message; };
  EXPECT_NE(refusal(with("EPSG:3031", "", levels)).find("<Origin>"), std::string::npos);
  EXPECT_NE(refusal(with("EPSG:3031", R"(<Origin x="nan" y="0"/>)", levels)).find("<Origin>"), std::string::npos);
  EXPECT_NE(refusal(with("EPSG:3031", R"(<Origin x="9000" y="0"/>)", levels)).find("ends before"), std::string::npos);
  EXPECT_NE(refusal(with("EPSG:999999", origin, levels)).find("EPSG:999999"), std::string::npos);
  const std::string tiny = R"(<TileSet href="0" units-per-pixel="1e-300"/>)";
  EXPECT_NE(refusal(with("EPSG:3031", origin, tiny)).find("too many tiles"), std::string::npos);
}

}  // namespace
}  // namespace terrella
