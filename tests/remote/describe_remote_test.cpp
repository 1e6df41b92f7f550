#include "streaming/remote/describe_remote.h"

#include <gtest/gtest.h>

#include <map>

#include "wmts_documents.h"

namespace terrella {
namespace {

/// The documents of a small web, and what was asked of it.
struct Web {
  std::map<std::string, std::string> pages;
  std::vector<std::string> asked;
  std::vector<std::string> headers;

  Result<RemoteTileSet> describe(const std::string& tile_set, const RemoteOptions& options = {}) {
    return describe_remote(
        tile_set, options,
        [&](const Url& address, const std::vector<std::string>& sent) -> Result<std::vector<std::byte>> {
          const std::string& url = address.with_secrets();
          asked.push_back(url);
          headers = sent;
          if (!pages.contains(url)) return Error{url + ": 404"};
          std::vector<std::byte> bytes;
          for (const char c : pages.at(url)) bytes.push_back(static_cast<std::byte>(c));
          return bytes;
        });
  }
};

constexpr const char* kTms =
    "<TileMap><Title>t</Title><SRS>EPSG:4326</SRS><BoundingBox minx=\"-180\" miny=\"-90\" maxx=\"180\" maxy=\"90\"/>"
    "<TileFormat width=\"256\" height=\"256\" extension=\"jpg\"/><TileSets profile=\"geodetic\">"
    "<TileSet href=\"http://example.com/t/zero\" units-per-pixel=\"0.703125\"/><TileSet href=\"1\" "
    "units-per-pixel=\"0.3515625\"/></TileSets></TileMap>";

void expect_error(const Result<RemoteTileSet>& set, const std::string& why) {
  ASSERT_FALSE(set);
  EXPECT_NE(set.error().message.find(why), std::string::npos) << set.error().message;
}

TEST(IsRemote, GoesByTheTextAlone) {
  for (const char* remote : {"https://a/{z}/{x}/{y}.png", "http://a/caps.xml", "FILE:///a/b", "ftp://a", "a.json",
                             "folder/caps.XML", "a/{z}/b"}) {
    EXPECT_TRUE(is_remote(remote)) << remote;
  }
  for (const char* local :
       {"planet.gpkg", "folder", "folder/tileset.json", "t/tilemapresource.xml", "a.jpg", "C:/a.png", ""}) {
    EXPECT_FALSE(is_remote(local)) << local;
  }
}

TEST(DescribeRemote, ADescriptionSaysWhatHeightsMean) {
  Web web;
  web.pages["http://a.org/h.json"] =
      R"({"url": "http://a.org/{z}/{x}/{y}", "max_level": 3, "elevation": {"scale": 0.5, "offset": -100, "nodata": 0}})";
  const auto set = web.describe("http://a.org/h.json");
  ASSERT_TRUE(set) << set.error().message;
  EXPECT_EQ(set->info.numbers,
            (NumberInfo{.scale = 0.5, .offset = -100.0, .nodata = 0.0, .whole = WholeRange{0, 65535}}));
  EXPECT_EQ(set->info.format, ImageFormat::png);
  web.pages["http://a.org/t.xml"] = kTms;
  web.pages["http://a.org/t.json"] = R"({"tms": "http://a.org/t.xml", "elevation": {"scale": 1, "offset": 0}})";
  expect_error(web.describe("http://a.org/t.json"), "no PNG pictures");
}

TEST(DescribeRemote, ATemplateAsksForNothing) {
  Web web;
  const auto set = web.describe("https://a.org/{z}/{x}/{y}.png", {.max_level = 3});
  ASSERT_TRUE(set) << set.error().message;
  EXPECT_TRUE(web.asked.empty());
}

TEST(DescribeRemote, KnowsCapabilitiesByAddressOrContent) {
  Web web;
  for (const char* url : {"https://a.org/1.0.0/WMTSCapabilities.xml",
                          "https://a.org/w?SERVICE=WMTS&request=GetCapabilities", "https://a.org/anything"}) {
    web.pages[url] = test::gibs_document();
    const auto set = web.describe(url, {.layer = "Still"});
    ASSERT_TRUE(set) << set.error().message;
    EXPECT_NEAR(set->info.grid.root_span_deg, 288.0, 1e-9);
  }
}

TEST(DescribeRemote, TmsTilesLieBesideTheirDescription) {
  Web web;
  web.pages["https://a.org/t/tilemapresource.xml?key=1"] = kTms;
  const auto set = web.describe("https://a.org/t/tilemapresource.xml?key=1");
  ASSERT_TRUE(set) << set.error().message;
  EXPECT_EQ(tile_url(*set, {0, 1, 0}), "https://a.org/t/zero/1/0.jpg?key=1");
  EXPECT_EQ(tile_url(*set, {1, 3, 0}), "https://a.org/t/1/3/1.jpg?key=1");
  const auto one_root = web.describe("https://a.org/t/tilemapresource.xml?key=1", {.root_span_deg = 360.0});
  ASSERT_TRUE(one_root) << one_root.error().message;
  EXPECT_EQ(one_root->info.grid.min_level, 1);
}

TEST(DescribeRemote, AJsonMayPointToACapabilitiesDocument) {
  Web web;
  web.pages["https://a.org/s.json"] =
      R"({"wmts": "https://a.org/caps", "layer": "Daily", "time": "2012-07-09", "headers": ["A: b"], "attribution": "me"})";
  web.pages["https://a.org/caps"] = test::gibs_document();
  const auto elsewhere = web.describe("https://a.org/s.json");
  expect_error(elsewhere, "example.com");  // tiles of another host than the headers are for
  web.pages["https://a.org/s.json"].replace(web.pages["https://a.org/s.json"].find("\"headers\": [\"A: b\"], "), 21,
                                            "");
  const auto set = web.describe("https://a.org/s.json", {.time = "2013-01-01"});
  ASSERT_TRUE(set) << set.error().message;
  EXPECT_NE(tile_url(*set, {}).with_secrets().find("/2013-01-01/"), std::string::npos) << set->url.redacted();
  EXPECT_EQ(set->info.attribution, "me");
}

TEST(DescribeRemote, NothingFromTheNetworkPointsToFiles) {
  Web web;
  web.pages["https://a.org/s.json"] = R"({"url": "file:///etc/{z}/{x}/{y}", "max_level": 2})";
  expect_error(web.describe("https://a.org/s.json"), "must begin with http");
  web.pages["https://a.org/s.json"] = R"({"wmts": "file:///etc/passwd"})";
  expect_error(web.describe("https://a.org/s.json"), "not on the network");
  web.pages["https://a.org/s.json"] = R"({"tms": "/etc/passwd"})";
  expect_error(web.describe("https://a.org/s.json"), "not on the network");
}

TEST(DescribeRemote, FilesOfThisMachineAreNamedByTheirPath) {
  Web web;
  for (const char* file : {"file:///a/planet.pmtiles", "file:///a/planet.gpkg", "FILE:///a/planet.tif"}) {
    expect_error(web.describe(file), "give the path /a/planet.");
  }
  EXPECT_TRUE(web.asked.empty());
  web.pages["file:///a/tilemapresource.xml"] = kTms;
  EXPECT_TRUE(web.describe("file:///a/tilemapresource.xml"));
}

TEST(DescribeRemote, HeadersStayWithTheirSchemeHostAndPort) {
  Web web;
  web.pages["https://a.org/s.json"] = R"({"url": "https://b.org/{z}/{x}/{y}", "max_level": 2})";
  const RemoteOptions secret{.headers = {"Authorization: hush"}};
  const auto refused = web.describe("https://a.org/s.json", secret);
  expect_error(refused, "b.org");
  EXPECT_EQ(refused.error().message.find("hush"), std::string::npos);
  for (const char* other : {"https://a.org:8443", "http://a.org", "https://t.a.org"}) {
    web.pages["https://a.org/s.json"] = R"({"url": ")" + std::string(other) + R"(/{z}/{x}/{y}", "max_level": 2})";
    expect_error(web.describe("https://a.org/s.json", secret), "port");
    web.pages["https://a.org/s.json"] = R"({"wmts": ")" + std::string(other) + R"(/caps"})";
    expect_error(web.describe("https://a.org/s.json", secret), "port");
  }
  web.pages["https://a.org/s.json"] = R"({"url": "https://a.org/{z}/{x}/{y}", "max_level": 2})";
  const auto kept = web.describe("https://a.org/s.json", secret);
  ASSERT_TRUE(kept) << kept.error().message;
  EXPECT_EQ(kept->headers, secret.headers);
  EXPECT_EQ(web.headers, secret.headers);
}

TEST(DescribeRemote, NamesWhatItCannotUse) {
  Web web;
  web.pages["https://a.org/page"] = "<html/>";
  expect_error(web.describe("https://a.org/page"), "https://a.org/page: neither a URL template");
  expect_error(web.describe("https://a.org/missing"), "404");
  expect_error(web.describe("ftp://a.org/caps.xml"), "http, https and file");
  expect_error(web.describe("/no/such/file.json"), "/no/such/file.json");
  expect_error(web.describe("a/{z}/{x}/{y}", {.max_level = 2}), "must begin with http");
}

}  // namespace
}  // namespace terrella
