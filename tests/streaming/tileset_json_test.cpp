#include "streaming/sets/tileset_json.h"

#include <gtest/gtest.h>

#include <string>

namespace terrella {
namespace {

TileSetInfo some_info() {
  TileSetInfo info;
  info.name = "Mars \"MOLA\" é";
  info.attribution = "NASA";
  info.body = "3396190,0.005886";
  info.grid = {.root_span_deg = 273.06666666666666,
               .tile_px = 512,
               .min_level = 1,
               .max_level = 6,
               .projection = Projection::equal_area,
               .latitude = LatitudeKind::centric,
               .bounds = {.west = Angle::degrees(170.0),
                          .south = Angle::degrees(-45.5),
                          .east = Angle::degrees(-170.0),
                          .north = Angle::degrees(45.0)}};
  info.format = ImageFormat::png;
  return info;
}

/// The text that older versions wrote must stay readable, so this changes only with the version.
constexpr const char* kGolden = R"({
  "version": 1,
  "name": "Mars \"MOLA\" é",
  "attribution": "NASA",
  "body": "3396190,0.005886",
  "root_span_deg": 273.06666666666666,
  "tile_px": 512,
  "min_level": 1,
  "max_level": 6,
  "projection": "equal-area",
  "latitude": "centric",
  "bounds": [
    170.0,
    -45.5,
    -170.0,
    45.0
  ],
  "format": "png"
}
)";

std::string json_error_of(const std::string& text) {
  const auto read = parse_tileset_json(text, "set/tileset.json");
  EXPECT_FALSE(read) << text;
  return read ? "" : read.error().message;
}

/// The least description, with one field replaced or added.
std::string with(const std::string& field, const std::string& value) {
  std::string text = R"({"root_span_deg": 180, "tile_px": 256, "max_level": 3, "format": "jpg"})";
  const auto at = text.find('"' + field + '"');
  if (at == std::string::npos) return text.insert(1, '"' + field + "\": " + value + ", ");
  const auto begin = text.find(": ", at) + 2;
  return text.replace(begin, text.find_first_of(",}", begin) - begin, value);
}

void expect_json_refused(const std::string& field, const std::string& value) {
  const std::string message = json_error_of(with(field, value));
  EXPECT_NE(message.find("set/tileset.json"), std::string::npos) << message;
  EXPECT_NE(message.find(field), std::string::npos) << message;
}

TEST(TileSetJson, IsWrittenAsItWas) { EXPECT_EQ(to_tileset_json(some_info()), kGolden); }

TEST(TileSetJson, ComesBack) {
  const TileSetInfo info = some_info();
  const auto back = parse_tileset_json(kGolden, "golden");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->name, info.name);
  EXPECT_EQ(back->attribution, info.attribution);
  EXPECT_EQ(back->body, info.body);
  EXPECT_EQ(back->grid, info.grid);
  EXPECT_EQ(back->format, info.format);
}

TEST(TileSetJson, WhatMayBeLeftOutHasItsDefault) {
  const auto info =
      parse_tileset_json(R"({"root_span_deg": 288, "tile_px": 512, "max_level": 3, "format": "jpg"})", "least");
  ASSERT_TRUE(info) << info.error().message;
  EXPECT_EQ(info->grid, (TileGrid{.root_span_deg = 288.0, .tile_px = 512, .min_level = 0, .max_level = 3}));
  EXPECT_EQ(info->name, "");
  EXPECT_EQ(info->format, ImageFormat::jpeg);
}

TEST(TileSetJson, UnknownFieldsArePassedOver) { EXPECT_TRUE(parse_tileset_json(with("minzoom", "7"), "here")); }

TEST(TileSetJson, EachFieldIsChecked) {
  for (const char* value : {"0", "-180", "1e-9", "20000", "\"wide\"", "null", "[180]"})
    expect_json_refused("root_span_deg", value);
  for (const char* value : {"0", "15", "4097", "-256", "256.5", "1e18", "\"256\"", "null"})
    expect_json_refused("tile_px", value);
  for (const char* value : {"-1", "25", "1e9", "18446744073709551615", "2.5", "null"})
    expect_json_refused("max_level", value);
  for (const char* value : {"-1", "4", "true"}) expect_json_refused("min_level", value);
  for (const char* value : {"\"mercator\"", "1", "[]"}) expect_json_refused("projection", value);
  for (const char* value : {"\"geodetic\"", "false"}) expect_json_refused("latitude", value);
  for (const char* value : {"\"gif\"", "null"}) expect_json_refused("format", value);
  for (const char* value : {"7", "{}"}) expect_json_refused("name", value);
  for (const char* value : {"\"vulcan\"", "7", "\"-5,0\""}) expect_json_refused("body", value);
  for (const char* value : {"0", "2", "\"1\""}) expect_json_refused("version", value);
  for (const char* value : {"[0, 0, 1]", "[0, 0, 1, \"x\"]", "[-181, 0, 1, 1]", "[0, 5, 1, 5]", "[0, 5, 1, 4]",
                            "[0, 0, 0, 1]", "[0, -91, 1, 1]", "\"all\""}) {
    expect_json_refused("bounds", value);
  }
}

TEST(TileSetJson, TheSystemOfASquareNamesNoFile) {
  const auto with_system = [](const std::string& crs) {
    return R"({"root_span_deg": 360, "tile_px": 256, "max_level": 3, "format": "jpg", "projection": "projected", )"
           R"("square": {"west": 0, "north": 0, "unit_per_deg": 1, "crs": ")" +
           crs + R"("}})";
  };
  for (const char* crs : {"/etc/passwd", "+init=/etc/passwd:1", "+proj=utm +zone=33 +nadgrids=/etc/passwd"}) {
    EXPECT_NE(json_error_of(with_system(crs)).find("square"), std::string::npos) << crs;
  }
  for (const char* crs : {"EPSG:32633", "IAU_2015:30100", "+proj=stere +lat_0=90 +R=1737400 +type=crs"}) {
    EXPECT_TRUE(parse_tileset_json(with_system(crs), "good")) << crs;
  }
}

TEST(TileSetJson, TextsHaveALimit) { expect_json_refused("name", '"' + std::string(20000, 'x') + '"'); }

TEST(TileSetJson, SaysWhereTheTextIsNotJson) {
  EXPECT_NE(json_error_of("").find("not JSON"), std::string::npos);
  EXPECT_NE(json_error_of("{\"name\": \"\xff\"}").find("not JSON"), std::string::npos);
  EXPECT_NE(json_error_of("[]").find("object"), std::string::npos);
  EXPECT_NE(json_error_of("{\"root_span_deg\": 1e999}").find("set/tileset.json"), std::string::npos);
}

TEST(TileSetJson, BytesThatAreNotUtf8AreReplacedOnWriting) {
  TileSetInfo info;
  info.name = "caf\xe9";
  const auto back = parse_tileset_json(to_tileset_json(info), "here");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->name, "caf\xEF\xBF\xBD");
}

}  // namespace
}  // namespace terrella
