#include "apps/serve/tile_server.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "apps/process/write_file.h"
#include "tests/serve/served_tiles.h"
#include "tests/support/scratch_folder.h"

namespace terrella {
namespace {

using test::NamedTiles;

/// A server of a geodetic set "geo", a web one "web", and the archive "arc" of 1000 bytes.
class TileServerTest : public testing::Test {
 protected:
  TileServerTest() {
    std::vector<std::byte> bytes(1000);
    EXPECT_TRUE(write_file(folder_ / "archive", bytes).ok());
    const int file = open((folder_ / "archive").c_str(), O_RDONLY | O_CLOEXEC);
    std::vector<ServedSet> sets{{.name = "geo", .tiles = geo_},
                                {.name = "web", .tiles = web_},
                                {.name = "arc", .tiles = web_, .archive = std::make_shared<Descriptor>(file)}};
    server_ = std::make_unique<TileServer>(std::move(sets), [this](const std::string& line) { log_.push_back(line); });
  }

  [[nodiscard]] WebAnswer get(std::string_view target) const {
    return server_->answer({.target = target, .base = kBase});
  }
  void expect_tile(std::string_view target, const TileId& id) const {
    const WebAnswer answer = get(target);
    EXPECT_EQ(answer.status, 200) << target;
    EXPECT_EQ(answer.type, "image/png");
    EXPECT_TRUE(test::text(answer).ends_with(NamedTiles::mark(id))) << target;
  }

  static constexpr const char* kBase = "http://127.0.0.1:8080";
  test::ScratchFolder folder_;
  std::shared_ptr<NamedTiles> geo_ = std::make_shared<NamedTiles>(test::geodetic_info());
  std::shared_ptr<NamedTiles> web_ = std::make_shared<NamedTiles>(test::web_info());
  std::vector<std::string> log_;
  std::unique_ptr<TileServer> server_;
};

TEST_F(TileServerTest, GivesOneTileByEachKindOfAddress) {
  const TileId tile{.level = 2, .x = 5, .y = 1};  // level 2 has 8 columns and 4 rows
  expect_tile("/geo/2/5/1.png", tile);
  expect_tile("/geo/2/5/1.png?v=1", tile);
  expect_tile("/geo/tms/2/5/2.png", tile);
  expect_tile("/geo/wmts/geo/2/1/5.png", tile);
  expect_tile(
      "/wmts?service=WMTS&Request=GetTile&LAYER=geo&TILEMATRIXSET=geo&TILEMATRIX=2&TILEROW=1&TILECOL=5&FORMAT=image%"
      "2Fpng",
      tile);
  expect_tile("/web/tms/2/3/2.png", {.level = 2, .x = 3, .y = 1});  // level 2 has 4 rows
}

TEST_F(TileServerTest, CountsTheZoomOfTheWebPyramidWhateverTheRootTile) {
  TileSetInfo info = test::web_info();
  info.grid.root_span_deg = 90.0;  // 4 columns: zoom 2
  const TileServer server({{.name = "deep", .tiles = std::make_shared<NamedTiles>(info)}}, [](const std::string&) {});
  EXPECT_EQ(server.answer({.target = "/deep/1/0/0.png"}).status, 404);
  EXPECT_TRUE(test::text(server.answer({.target = "/deep/3/7/1.png"})).ends_with("1/7/1"));
}

TEST_F(TileServerTest, LeadsNowhereByHostilePaths) {
  using namespace std::string_view_literals;
  const std::string longest = "/geo/" + std::string(4000, '0') + "/0/0.png", too_long = "/" + std::string(5000, 'a');
  for (const std::string_view target : {""sv,
                                        "x"sv,
                                        "xgeo/0/0/0.png"sv,
                                        "*"sv,
                                        "//"sv,
                                        "/.."sv,
                                        "/geo"sv,
                                        "/geo/"sv,
                                        "/geo/../geo/0/0/0.png"sv,
                                        "/%2e%2e/etc/passwd"sv,
                                        "/../../etc/passwd"sv,
                                        "/geo/..%2f..%2fetc/0/0.png"sv,
                                        "/geo/0/0/0.png%00"sv,
                                        "/geo/0/0/0.png\0.png"sv,
                                        "/geo%00/0/0/0.png"sv,
                                        "/geo/-1/0/0.png"sv,
                                        "/geo/0/-1/0.png"sv,
                                        "/geo/0/0/-1.png"sv,
                                        "/geo/99/0/0.png"sv,
                                        "/geo/4/0/0.png"sv,
                                        "/geo/0/2/0.png"sv,
                                        "/geo/0/0/1.png"sv,
                                        "/geo/tms/0/0/1.png"sv,
                                        "/geo/18446744073709551616/0/0.png"sv,
                                        "/geo/0/9223372036854775807/0.png"sv,
                                        "/geo/0/0/0.exe"sv,
                                        "/geo/0/0/0"sv,
                                        "/geo/0/0/0.png.png"sv,
                                        "/geo/0/0/.png"sv,
                                        "/geo/00/0/0.png"sv,
                                        "/geo/0/0/0.png/"sv,
                                        "/geo/0/0/0/0/0/0/0/0"sv,
                                        "/geo/wmts/web/0/0/0.png"sv,
                                        "/geo.pmtiles"sv,
                                        "/.pmtiles"sv,
                                        "/arc.pmtiles/"sv,
                                        "/../arc.pmtiles"sv,
                                        "http://127.0.0.1/geo/0/0/0.png"sv,
                                        "/g\xC3\xA9o/0/0/0.png"sv,
                                        std::string_view(longest)}) {
    EXPECT_EQ(get(target).status, 404) << target;
  }
  EXPECT_EQ(get(too_long).status, 414);
  EXPECT_EQ(geo_->strays + web_->strays, 0);
}

TEST_F(TileServerTest, ExplainsWrongKeysAsWmtsDoes) {
  for (const char* target : {"/wmts", "/wmts?", "/wmts?REQUEST=GetMap", "/wmts?REQUEST=GetTile&LAYER=geo",
                             "/wmts?REQUEST=GetTile&LAYER=none&TILEMATRIXSET=none"}) {
    EXPECT_EQ(get(target).status, 400) << target;
    EXPECT_NE(test::text(get(target)).find("<ExceptionText>"), std::string_view::npos) << target;
  }
}

TEST_F(TileServerTest, SaysThatAKnownTileIsUnchanged) {
  const WebAnswer first = get("/geo/1/0/0.png");
  ASSERT_FALSE(first.etag.empty());
  EXPECT_NE(first.etag, get("/geo/1/1/0.png").etag);
  const WebAnswer again = server_->answer({.target = "/geo/1/0/0.png", .if_none_match = "\"other\", W/" + first.etag});
  EXPECT_EQ(again.status, 304);
  EXPECT_EQ(again.etag, first.etag);
  EXPECT_TRUE(again.bytes.empty());
  EXPECT_EQ(server_->answer({.target = "/geo/1/0/0.png", .if_none_match = "\"other\""}).status, 200);
}

TEST_F(TileServerTest, AnswersReadingMethodsAlone) {
  EXPECT_EQ(server_->answer({.method = "HEAD", .target = "/geo/0/0/0.png"}).bytes, get("/geo/0/0/0.png").bytes);
  EXPECT_EQ(server_->answer({.method = "OPTIONS", .target = "/geo/0/0/0.png"}).status, 204);
  for (const char* method : {"POST", "PUT", "DELETE", "TRACE", "get", ""}) {
    EXPECT_EQ(server_->answer({.method = method, .target = "/geo/0/0/0.png"}).status, 405) << method;
  }
}

TEST_F(TileServerTest, TellsMissingFromBrokenTiles) {
  const std::pair<MissingKind, int> kinds[] = {
      {MissingKind::absent, 404}, {MissingKind::blank, 404}, {MissingKind::broken, 500}, {MissingKind::failed, 503}};
  for (const auto& [kind, status] : kinds) {
    geo_->failure = TileFailure{kind, "reason"};
    EXPECT_EQ(get("/geo/0/0/0.png").status, status);
  }
  EXPECT_EQ(log_, std::vector<std::string>(2, "geo: level 0, column 0, row 0: reason"));
  geo_->failure.reset();
  geo_->is_cut_short = true;
  EXPECT_EQ(get("/geo/0/0/0.png").status, 500);
  EXPECT_EQ(log_.size(), 3U);
  for (int i = 0; i < 2 * TileServer::kMostLogged; ++i) static_cast<void>(get("/geo/0/0/0.png"));
  EXPECT_EQ(log_.size(), TileServer::kMostLogged + 1U);
}

TEST_F(TileServerTest, GivesPartsOfAnArchive) {
  const WebAnswer whole = get("/arc.pmtiles");
  EXPECT_EQ(whole.status, 200);
  EXPECT_EQ(whole.of_file, (ByteRange{0, 1000}));
  const auto ask = [&](std::string_view range, std::string_view if_range) {
    return server_->answer({.target = "/arc.pmtiles", .range = range, .if_range = if_range});
  };
  const WebAnswer part = ask("bytes=10-19", {});
  EXPECT_EQ(part.status, 206);
  EXPECT_EQ(part.of_file, (ByteRange{10, 10}));
  EXPECT_EQ(part.content_range, "bytes 10-19/1000");
  EXPECT_EQ(ask("bytes=10-19", whole.etag).status, 206);
  EXPECT_EQ(ask("bytes=10-19", "\"older\"").status, 200);
  EXPECT_EQ(ask("bytes=1000-", {}).status, 416);
  EXPECT_EQ(ask("bytes=1000-", {}).content_range, "bytes */1000");
  EXPECT_EQ(server_->answer({.target = "/arc.pmtiles", .if_none_match = whole.etag}).status, 304);
}

TEST_F(TileServerTest, MakesTilesOfRastersLater) {
  const TileServer server({{.name = "made", .tiles = geo_, .is_made = true}}, [](const std::string&) {});
  const WebAnswer promise = server.answer({.target = "/made/0/1/0.png"});
  ASSERT_TRUE(promise.later);
  EXPECT_TRUE(test::text(promise.later()).ends_with("0/1/0"));
}

/// Changes a valid request at random places. Each answer is one of a few, and no tile beyond the grids is read.
TEST_F(TileServerTest, StaysWithinTheSetsUnderMutation) {
  const std::string seeds[] = {
      "/geo/2/5/1.png",
      "/geo/tms/2/5/2.png",
      "/geo/wmts/geo/2/1/5.png",
      "/web/wmts/1.0.0/WMTSCapabilities.xml",
      "/wmts?SERVICE=WMTS&REQUEST=GetTile&LAYER=geo&TILEMATRIXSET=geo&TILEMATRIX=2&TILEROW=1&TILECOL=5",
      "/web/tilejson.json",
      "/arc.pmtiles",
      "bytes=10-19",
      "bytes=-5",
      "bytes=999-"};
  constexpr std::string_view kPieces[] = {"..",  "/", "%2e", "%", "\0", "-", "9", "99999999999999999999",
                                          "tms", "=", "&",   ","};
  std::mt19937 random(35);
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  const auto mutated = [&](std::string text) {
    for (std::size_t i = below(4); i > 0; --i) {
      const std::size_t at = below(text.size() + 1);
      const std::size_t kind = below(4);
      if (kind == 0) text.insert(at, kPieces[below(std::size(kPieces))]);
      if (kind == 1) text.erase(at, below(5));
      if (kind == 2 && at < text.size()) text[at] = static_cast<char>(below(256));
      if (kind == 3) text.insert(at, text.substr(below(text.size() + 1)));
    }
    return text;
  };
  std::map<int, int> statuses;
  for (int i = 0; i < 20'000; ++i) {
    const std::string target = mutated(seeds[below(7)]), range = mutated(seeds[7 + below(3)]);
    const WebAnswer answer = server_->answer({.target = target, .base = kBase, .if_none_match = range, .range = range});
    ++statuses[answer.status];
    if (answer.file) {
      EXPECT_LE(answer.of_file.offset + answer.of_file.length, 1000U) << range;
    }
  }
  for (const int status : {200, 206, 400, 404, 416}) EXPECT_GT(statuses[status], 0) << status;
  for (const auto& [status, count] : statuses) {
    EXPECT_TRUE(status == 200 || status == 206 || status == 304 || status == 400 || status == 404 || status == 414 ||
                status == 416)
        << status;
  }
  EXPECT_EQ(geo_->strays + web_->strays, 0);
}

}  // namespace
}  // namespace terrella
