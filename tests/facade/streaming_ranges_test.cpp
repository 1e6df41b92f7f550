// The ranges that the public headers of streaming state.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "geo/body.h"
#include "geo/measure.h"
#include "streaming/cut.h"
#include "streaming/http/http_fetcher.h"
#include "streaming/http/reply_queue.h"
#include "streaming/preload/preloader.h"
#include "view/color_map.h"
#include "view/navigation.h"

namespace terrella::test {
namespace {

class StreamingRanges : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("terrella_ranges_" + std::to_string(getpid()));
};

TEST_F(StreamingRanges, OptionsOfHttpCountAsTheNearestEnd) {
  std::ofstream(folder_ / "seven.txt") << "7 bytes";
  HttpOptions options;
  options.connections_per_host = options.attempts = 0;
  options.in_flight_per_host = -1;
  options.rate_per_host = options.burst = std::numeric_limits<double>::quiet_NaN();
  options.first_backoff = options.longest_backoff = std::chrono::milliseconds(-1);
  ReplyQueue replies;
  HttpFetcher fetcher(options, replies);
  HttpRequest request;
  request.url = "file://" + (folder_ / "seven.txt").string();
  fetcher.submit(request);
  const auto reply = replies.take();
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->body.size(), 7U) << reply->why;
}

TEST_F(StreamingRanges, AWindowOfNoRequestIsAnError) {
  TileSetInfo info;
  info.grid = {.max_level = 1};
  const auto cache = TileCache::open(folder_ / "cache.gpkg", info, "nowhere");
  ASSERT_TRUE(cache) << cache.error().message;
  const auto plan = plan_list({{}});
  for (const std::size_t window : {std::size_t{0}, std::size_t{100'001}}) {
    PreloadOptions options;
    options.window = window;
    const auto done = preload(
        *plan, **cache, [](ReplyQueue&) { return std::unique_ptr<TileOrigin>(); }, options);
    ASSERT_FALSE(done);
    EXPECT_NE(done.error().message.find("a window of " + std::to_string(window)), std::string::npos);
  }
}

TEST_F(StreamingRanges, OfCuts) {
  using O = CutOptions;
  const std::vector<Row<O>> rows = {
      {"tile_px", {16, 4096}, {-2, 0, 15, 17, 4098}, [](O& o, double v) { o.tile_px = int(v); }},
      {"quality", {1, 100}, {0, 101}, [](O& o, double v) { o.quality = int(v); }},
      {"format", {0, 2}, {-1, 3, 4}, [](O& o, double v) { o.format = ImageFormat(int(v)); }},
      {"columns",
       {1},
       {-1, 0, 100'001},
       [](O& o, double v) {
         o.mosaic = MosaicGrid{int(v), 1};
       }},
      {"rows",
       {1},
       {-1, 0, 100'001},
       [](O& o, double v) {
         o.mosaic = MosaicGrid{1, int(v)};
       }},
      {"scale",
       {-1e9, 1e9},
       {0.0, 1.1e9, kNoNumberAtAll, kInfinite},
       [](O& o, double v) { o.elevation = CutElevation{.scale = v}; }},
      {"offset",
       {-1e9, 1e9},
       {1.1e9, kNoNumberAtAll, -kInfinite},
       [](O& o, double v) { o.elevation = CutElevation{.offset = v}; }},
      {"band", {1, 65535}, {-1, 0, 65536}, [](O& o, double v) { o.numbers = CutNumbers{.band = int(v)}; }},
      {"bands",
       {1, 65535},
       {-1, 0, 65536},
       [](O& o, double v) {
         o.composite = CutBands{.bands = {1, int(v), 1}};
       }},
      {"stretch",
       {2.0},
       {kNoNumberAtAll, kInfinite},
       [](O& o, double v) { o.composite = CutBands{.stretch = {StretchRule{.low = v}}}; }},
      {"kind",
       {0, 3},
       {-1, 4},
       [](O& o, double v) { o.composite = CutBands{.stretch = {StretchRule{.kind = StretchRule::Kind(int(v))}}}; }},
      {"west_deg", {-360, 360}, {-361, 361, kNoNumberAtAll}, [](O& o, double v) { o.west_deg = v; }},
      {"grid", {0, 1}, {-1, 2}, [](O& o, double v) { o.grid = CutGrid(int(v)); }},
      {"projection", {0, 1}, {-1, 2, 3, 4}, [](O& o, double v) { o.projection = Projection(int(v)); }},
      {"latitude", {0, 1}, {-1, 2}, [](O& o, double v) { o.latitude = LatitudeKind(int(v)); }},
      {"jobs", {0, 256}, {-1, 257}, [](O& o, double v) { o.jobs = int(v); }},
      {"index", {1, 3}, {-1, 0, 4}, [](O& o, double v) { o.shard = CutShard{.index = int(v), .count = 3}; }},
      {"count",
       {1, 100'000},
       {-1, 0, 100'001},
       [](O& o, double v) { o.shard = CutShard{.index = 1, .count = int(v)}; }},
      {"row_step", {1}, {-1, 0}, [](O& o, double v) { o.watch.emplace().row_step = std::int64_t(v); }}};
  const O whole{.images = {folder_ / "nowhere.tif"}, .output = folder_ / "out"};
  expect_ranges<O>(whole, rows, "cut: ", [](const O& options) {
    const std::string why = cut(options).error().message;  // good options fail at the file, which is not there
    return why.find("nowhere.tif") != why.npos ? Status(Done{}) : Status(Error{"cut: " + why});
  });
}

TEST_F(StreamingRanges, ACacheOfNoBatchWritesSingleTiles) {
  TileSetInfo info;
  info.grid = {.max_level = 1};
  const auto cache =
      TileCache::open(folder_ / "cache.gpkg", info, "nowhere", {.batch_tiles = 0, .max_queued_bytes = 0});
  ASSERT_TRUE(cache) << cache.error().message;
  CacheRecord sea;
  sea.missing = MissingKind::absent;
  for (const int x : {0, 1}) (*cache)->store({0, x, 0}, sea);
  EXPECT_TRUE((*cache)->flush());
}

TEST(PlainRanges, FewerThanTwoPlacesAreTwo) {
  for (const int count : {-5, 0, 1, 2}) {
    EXPECT_EQ(geodesic_places(earth().ellipsoid, {}, {.lat = Angle::degrees(1.0), .lon = {}}, count).size(), 2U);
  }
}

TEST(PlainRanges, AMapWithoutColoursIsBlack) { EXPECT_EQ(color_at({}, 0.5), Rgba8{}); }

TEST(PlainRanges, ANavigatorIgnoresACameraOutOfRange) {
  const Camera wrong{.eye = {.lat = Angle::degrees(200.0), .lon = {}, .height_m = 1e7}};
  Navigator navigator(wrong, earth().ellipsoid, {100, 100});
  EXPECT_EQ(navigator.camera(), Camera{});
  navigator.set_camera(wrong);
  navigator.fly_to(wrong, Seconds(0.0));
  EXPECT_EQ(navigator.camera(), Camera{});
  EXPECT_TRUE(navigator.at_rest());
}

}  // namespace
}  // namespace terrella::test
