#include "streaming/sets/tms_xml.h"

#include <gtest/gtest.h>

#include <string>

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

}  // namespace
}  // namespace terrella
