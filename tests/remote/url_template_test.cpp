#include "streaming/remote/url_template.h"

#include <gtest/gtest.h>

#include <set>

#include "streaming/remote/web_address.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

RemoteTileSet make(const std::string& url, RemoteOptions options = {}) {
  if (!options.max_level) options.max_level = 5;
  auto set = template_tile_set(url, options, true, "test");
  EXPECT_TRUE(set) << set.error().message;
  return set ? *std::move(set) : RemoteTileSet{};
}

void expect_template_refused(const std::string& url, const std::string& why,
                             const RemoteOptions& options = {.max_level = 5}) {
  const auto set = template_tile_set(url, options, false, "here");
  ASSERT_FALSE(set) << url;
  EXPECT_NE(set.error().message.find(why), std::string::npos) << set.error().message;
  EXPECT_TRUE(set.error().message.starts_with("here: ")) << set.error().message;
}

TEST(UrlTemplate, PutsLevelColumnAndRowInTheirPlaces) {
  const RemoteTileSet set = make("https://example.com/a/{z}/{x}/{y}.png?v=1");
  EXPECT_EQ(tile_url(set, {3, 5, 2}), "https://example.com/a/3/5/2.png?v=1");
  EXPECT_EQ(set.info.format, ImageFormat::png);
  EXPECT_EQ(set.info.grid.root_span_deg, 180.0);
  EXPECT_EQ(set.info.grid.tile_px, 256);
  EXPECT_EQ(set.info.grid.max_level, 5);
}

TEST(UrlTemplate, CountsRowsFromTheSouth) {
  const RemoteTileSet set = make("http://example.com/{z}/{x}/{-y}.jpg");
  EXPECT_EQ(tile_url(set, {0, 1, 0}), "http://example.com/0/1/0.jpg");
  EXPECT_EQ(tile_url(set, {2, 0, 0}), "http://example.com/2/0/3.jpg");
  EXPECT_EQ(tile_url(set, {2, 0, 3}), "http://example.com/2/0/0.jpg");
}

TEST(UrlTemplate, LeavesOutTheOneRootTileWhoseRowsCountFromTheSouth) {
  const RemoteTileSet set = make("http://example.com/{z}/{x}/{-y}.jpg", {.root_span_deg = 360.0});
  EXPECT_EQ(set.info.grid.min_level, 1);
  EXPECT_EQ(tile_url(set, {1, 1, 0}), "http://example.com/1/1/0.jpg");
  expect_template_refused("http://example.com/{z}/{x}/{-y}.jpg", "which does not divide 180°",
                          {.root_span_deg = 288.0, .max_level = 2});
}

TEST(UrlTemplate, SendsATileAlwaysToTheSameSubdomain) {
  const RemoteTileSet set = make("http://{s}.example.com/{z}/{x}/{y}.jpg");
  std::set<std::string> hosts;
  for_each_place(set.info.grid, 3, [&](const TileId& id) {
    EXPECT_EQ(tile_url(set, id), tile_url(set, id));
    return hosts.insert(parse_address(tile_url(set, id))->host), true;
  });
  EXPECT_EQ(hosts, (std::set<std::string>{"a.example.com", "b.example.com", "c.example.com"}));
}

TEST(UrlTemplate, WrapsColumnsAndShiftsRows) {
  RemoteTileSet set = make("http://example.com/{z}/{row}/{col}.jpg");
  set.level_names = {"a", "b c/{x}"};
  set.shifts = {{}, {.columns = -2, .rows = 1, .turn_columns = 4}};
  EXPECT_EQ(tile_url(set, {1, 0, 0}), "http://example.com/b%20c%2F%7Bx%7D/1/2.jpg");
  EXPECT_EQ(tile_url(set, {1, 3, 1}), "http://example.com/b%20c%2F%7Bx%7D/2/1.jpg");
  EXPECT_EQ(tile_url(set, {0, 1, 0}), "http://example.com/a/0/1.jpg");
}

TEST(UrlTemplate, RefusesByNameWhatItIsNot) {
  expect_template_refused("https://example.com/{x}/{y}.png", "no {z}");
  expect_template_refused("https://example.com/{z}/{y}.png", "no {x}");
  expect_template_refused("https://example.com/{z}/{x}.png", "no {y}");
  expect_template_refused("https://example.com/{z}/{x}/{y}/{-y}.png", "both {y} and {-y}");
  expect_template_refused("https://example.com/{z}/{x}/{y}/{tile}.png", "unknown placeholder {tile}");
  expect_template_refused("https://example.com/{z}/{x}/{y", "brace");
  expect_template_refused("https://example.com/{z}/{x}/{y}}", "brace");
  expect_template_refused("https://{z}.example.com/{z}/{x}/{y}", "in its host");
  expect_template_refused("ftp://example.com/{z}/{x}/{y}.png", "must begin with http:// or https://");
  expect_template_refused("file:///tiles/{z}/{x}/{y}.png", "must begin with http:// or https://");
  expect_template_refused("example.com/{z}/{x}/{y}.png", "must begin with http:// or https://");
  expect_template_refused("https://example.com/{z}/{x}/{y} 1.png", "%20");
  expect_template_refused("https:///{z}/{x}/{y}", "address");
  expect_template_refused("https://example.com/" + std::string(9000, 'a') + "{z}/{x}/{y}", "longer than");
}

TEST(UrlTemplate, RefusesGridsOutOfRange) {
  const std::string url = "https://example.com/{z}/{x}/{y}.png";
  expect_template_refused(url, "‹levels›", {});
  expect_template_refused(url, "max_level", {.max_level = 25});
  expect_template_refused(url, "min_level", {.min_level = 3, .max_level = 2});
  expect_template_refused(url, "tile_px", {.tile_px = 3, .max_level = 2});
  expect_template_refused(url, "root_span_deg", {.root_span_deg = -1.0, .max_level = 2});
  expect_template_refused(url, "header 1", {.max_level = 2, .headers = {"A: b\r\nC: d"}});
  expect_template_refused(url, "sub-domain", {.max_level = 2, .subdomains = {"a/b"}});
}

TEST(UrlTemplate, KeepsSecretsOutOfMessages) {
  const auto set = template_tile_set("https://me:word@example.com/{z}/{x}?token=hush", {}, false, "here");
  ASSERT_FALSE(set);
  EXPECT_EQ(set.error().message.find("hush"), std::string::npos) << set.error().message;
  EXPECT_EQ(set.error().message.find("word"), std::string::npos) << set.error().message;
}

TEST(SourceKey, TellsSetsApartButHoldsNoSecret) {
  const auto key = [](const std::string& url, const RemoteOptions& options = {}) {
    return source_key(make(url, options));
  };
  const std::string base = "https://example.com/{z}/{x}/{y}.png";
  EXPECT_NE(key(base), key("https://example.com/b/{z}/{x}/{y}.png"));
  EXPECT_NE(key(base + "?style=a"), key(base + "?style=b"));
  EXPECT_EQ(key(base + "?style=a&api_key=1&b=2"), key(base + "?style=a&api_key=2&b=2"));
  EXPECT_EQ(key(base + "?AccessToken=1"), key(base + "?AccessToken=2"));
  EXPECT_EQ(key("https://me:1@example.com/{z}/{x}/{y}.png"), key("https://you:2@example.com/{z}/{x}/{y}.png"));
  EXPECT_EQ(key(base, {.headers = {"Authorization: Bearer hush"}}), key(base));
  EXPECT_EQ(key(base + "?sig=hush&X-Signature=hush").find("hush"), std::string::npos);
  RemoteTileSet named = make(base);
  named.level_names = {"a"};
  EXPECT_NE(source_key(named), key(base));
}

}  // namespace
}  // namespace terrella
