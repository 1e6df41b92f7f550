#include "streaming/remote/source_json.h"

#include <gtest/gtest.h>

#include <string>

namespace terrella {
namespace {

void expect_json_refused(const std::string& json, const std::string& why) {
  const auto source = parse_source_json(json, "a.json");
  ASSERT_FALSE(source) << json;
  EXPECT_NE(source.error().message.find(why), std::string::npos) << source.error().message;
  EXPECT_TRUE(source.error().message.starts_with("a.json: ")) << source.error().message;
}

TEST(SourceJson, SaysAllThatTheOptionsCan) {
  const auto source = parse_source_json(R"({"version": 1, "url": "https://{s}.example.com/{z}/{x}/{y}.png",
      "name": "n", "attribution": "a", "body": "mars", "subdomains": ["p", "q"], "headers": ["A: b"],
      "root_span_deg": 288, "tile_px": 512, "min_level": 1, "max_level": 7, "bounds": [-10, -20, 30, 40],
      "format": "png", "projection": "equal-area", "latitude": "centric", "tile_life_s": 60, "absence_life_s": 5})",
                                        "a.json");
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ(source->kind, SourceDescription::Kind::url_template);
  EXPECT_EQ(source->address, "https://{s}.example.com/{z}/{x}/{y}.png");
  const RemoteOptions& options = source->options;
  EXPECT_EQ(options.name, "n");
  EXPECT_EQ(options.attribution, "a");
  EXPECT_EQ(options.body, "mars");
  EXPECT_EQ(options.subdomains, (std::vector<std::string>{"p", "q"}));
  EXPECT_EQ(options.headers, std::vector<std::string>{"A: b"});
  EXPECT_EQ(options.root_span_deg, 288.0);
  EXPECT_EQ(options.tile_px, 512);
  EXPECT_EQ(options.min_level, 1);
  EXPECT_EQ(options.max_level, 7);
  EXPECT_EQ(options.bounds->north.deg(), Angle::degrees(40.0).deg());
  EXPECT_EQ(options.format, ImageFormat::png);
  EXPECT_EQ(options.projection, Projection::equal_area);
  EXPECT_EQ(options.latitude, LatitudeKind::centric);
  EXPECT_EQ(options.tile_life, std::chrono::seconds(60));
  EXPECT_EQ(options.missing_life, std::chrono::seconds(5));
}

TEST(SourceJson, PointsToAWmtsOrATms) {
  const auto wmts = parse_source_json(R"({"wmts": "https://example.com/c.xml", "layer": "l", "matrix_set": "m",
      "style": "s", "time": "2004-08-01"})",
                                      "a.json");
  ASSERT_TRUE(wmts) << wmts.error().message;
  EXPECT_EQ(wmts->kind, SourceDescription::Kind::wmts);
  EXPECT_EQ(wmts->options.layer, "l");
  EXPECT_EQ(wmts->options.matrix_set, "m");
  EXPECT_EQ(wmts->options.style, "s");
  EXPECT_EQ(wmts->options.time, "2004-08-01");
  const auto tms = parse_source_json(R"({"tms": "https://example.com/tilemapresource.xml"})", "a.json");
  ASSERT_TRUE(tms) << tms.error().message;
  EXPECT_EQ(tms->kind, SourceDescription::Kind::tms);
}

TEST(SourceJson, RefusesByFileAndField) {
  expect_json_refused("", "not JSON");
  expect_json_refused(R"({"url": "u", "elevation": 3})", "\"elevation\" must be an object");
  expect_json_refused(R"({"url": "u", "elevation": {"scale": 0, "offset": 0}})", "scale of 0");
  expect_json_refused(R"({"url": "u", "format": "jpg", "elevation": {"scale": 1, "offset": 0}})", "\"png\"");
  expect_json_refused("[]", "one JSON object");
  expect_json_refused("{}", "\"url\" is missing");
  expect_json_refused(R"({"url": "a", "wmts": "b"})", "one of the four");
  expect_json_refused(R"({"url": "a", "layer": "b"})", "\"layer\"");
  expect_json_refused(R"({"url": "a", "attributions": "b"})", "\"attributions\" is not known");
  expect_json_refused(R"({"url": 5})", "\"url\" must be a text");
  expect_json_refused(R"({"url": "a", "version": 2})", "\"version\"");
  expect_json_refused(R"({"url": "a", "max_level": 25})", "\"max_level\" must be in [0, 24]");
  expect_json_refused(R"({"url": "a", "max_level": 1.5})", "\"max_level\"");
  expect_json_refused(R"({"url": "a", "tile_px": 8})", "\"tile_px\"");
  expect_json_refused(R"({"url": "a", "root_span_deg": 0})", "\"root_span_deg\"");
  expect_json_refused(R"({"url": "a", "tile_life_s": -1})", "\"tile_life_s\"");
  expect_json_refused(R"({"url": "a", "bounds": [0, 0, 0, 1000]})", "bounds");
  expect_json_refused(R"({"url": "a", "format": "gif"})", "\"format\"");
  expect_json_refused(R"({"url": "a", "headers": "A: b"})", "\"headers\"");
  expect_json_refused(R"({"url": "a", "headers": ["no colon"]})", "header 1");
  expect_json_refused(R"({"url": "a", "subdomains": ["a b"]})", "sub-domain");
  expect_json_refused(R"({"url": "a", "body": "vulcan"})", "body");
  expect_json_refused("{\"url\": \"" + std::string(kMaxSourceJsonBytes, 'a') + "\"}", "too many");
}

TEST(SourceJson, DoesNotRepeatASecretInAMessage) {
  const auto broken = parse_source_json(R"({"headers": ["Authorization: hush)", "a.json");
  ASSERT_FALSE(broken);
  EXPECT_EQ(broken.error().message.find("hush"), std::string::npos) << broken.error().message;
}

TEST(RemoteOptions, WhatIsSaidWins) {
  const RemoteOptions merged = merge({.layer = "said", .max_level = 3, .headers = {"A: 1"}},
                                     {.layer = "other", .style = "s", .max_level = 9, .headers = {"B: 2"}});
  EXPECT_EQ(merged.layer, "said");
  EXPECT_EQ(merged.style, "s");
  EXPECT_EQ(merged.max_level, 3);
  EXPECT_EQ(merged.headers, (std::vector<std::string>{"A: 1", "B: 2"}));
}

}  // namespace
}  // namespace terrella
