// The ranges that the public headers of streaming state.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "geo/body.h"
#include "geo/measure.h"
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
