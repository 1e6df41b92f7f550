// A layer of 30 dates on a server with faults, played: every pixel of every frame is of one date.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <fstream>
#include <functional>
#include <set>
#include <thread>
#include <vector>

#include "codecs/image.h"
#include "http_test_support.h"
#include "streaming/remote/remote_source.h"
#include "streaming/remote/url_template.h"
#include "tests/gl/gl_fixture.h"
#include "tiles/painted_tiles.h"

namespace terrella::test {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr Viewport kTimes{96, 96};
constexpr int kDates = 30, kTilePx = 64, kLevels = 3;
constexpr int kMissing = 12, kRefused = 17, kLate = 22;  // dates with a fault

UtcTime date(int k) { return *parse_utc("2026-06-01") + std::chrono::days(k); }
std::string date_text(int k) { return time_text(date(k), TimePrecision::day, false); }

/// The colour of a date; no two dates have the same one.
std::uint8_t blue_of(int k) { return static_cast<std::uint8_t>(8 * k + 10); }
int date_of(std::uint8_t blue) { return (blue - 10) / 8; }

std::string png_of_date(int k) {
  Image image{kTilePx, kTilePx, {}};
  for (int i = 0; i < kTilePx * kTilePx; ++i) {
    for (const int part : {200, 40, int(blue_of(k)), 255}) image.rgba.push_back(static_cast<std::uint8_t>(part));
  }
  const auto bytes = *encode_png(image);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// nginx before a server whose dates have faults.
class DatedServer {
 public:
  DatedServer() {
    nlohmann::json faults = nlohmann::json::object();
    for (int k = 0; k < kDates; ++k) {
      const std::string png = png_of_date(k);
      for (const std::string& tile : tiles_of(k)) {
        if (k == kMissing) continue;
        write_file(folder_ / ("root/" + tile), png);
        if (k == kRefused) faults[tile] = "503?times=2";
        if (k == kLate) faults[tile] = "slow?seconds=3";
      }
    }
    write_file(folder_ / "faults.json", faults.dump());
    origin_ = std::make_unique<ServerProcess>(
        "misbehaving_server.py", std::vector<std::string>{"--until-stdin-ends", "--root", folder_ / "root", "--faults",
                                                          folder_ / "faults.json"});
    const std::string port = std::to_string(origin_->ready().at("port").get<int>());
    front_ = std::make_unique<ServerProcess>("nginx.py", std::vector<std::string>{folder_ / "root", "--pass", port});
  }
  [[nodiscard]] std::string url() const {
    return fmt::format("http://127.0.0.1:{}/{{time}}/{{z}}/{{x}}/{{y}}.png", front_->ready().at("port").get<int>());
  }
  /// The requests so far, one a line.
  [[nodiscard]] std::string asked() const { return read_text(front_->ready().at("access_log").get<std::string>()); }

 private:
  static std::vector<std::string> tiles_of(int k) {
    std::vector<std::string> all;
    for (int z = 0; z < kLevels; ++z) {
      for (int x = 0; x < 2 << z; ++x) {
        for (int y = 0; y < 1 << z; ++y) all.push_back(fmt::format("{}/{}/{}/{}.png", date_text(k), z, x, y));
      }
    }
    return all;
  }

  ScratchFolder folder_;
  std::unique_ptr<ServerProcess> origin_, front_;
};

std::shared_ptr<TileSource> source_of(const DatedServer& server, const ScratchFolder& caches) {
  const RemoteOptions options{.time = date_text(0),
                              .times = {date_text(0) + "/" + date_text(kDates - 1) + "/P1D"},
                              .tile_px = kTilePx,
                              .max_level = kLevels - 1};
  auto set = template_tile_set(server.url(), options, false, "dates");
  EXPECT_TRUE(set) << set.error().message;
  const OpenCache open_cache = [folder = caches.path()](const RemoteTileSet& at) -> Result<std::shared_ptr<TileCache>> {
    auto cache = TileCache::open(folder / (at.info.time + ".gpkg"), at.info, source_key(at));
    if (!cache) return cache.error();
    return *std::move(cache);
  };
  HttpOptions http = quick_options();
  http.first_backoff = milliseconds(300);
  return make_remote_source(*set, *open_cache(*set), http, open_cache);
}

class LayerTimes : public GlTest {
 protected:
  static void SetUpTestSuite() { server_ = std::make_unique<DatedServer>(); }
  static void TearDownTestSuite() { server_.reset(); }
  void begin(GlobeOptions options = unlit_options()) {
    options.gpu_bytes = 64UL << 20;
    globe_ = *Globe::create(options);
    const auto layer = globe_->add_imagery(source_of(*server_, caches_));
    ASSERT_TRUE(layer) << layer.error().message;
    layer_ = *layer;
    globe_->set_camera({.eye = {.lat = Angle::degrees(10), .lon = Angle::degrees(20), .height_m = 2.0e6}});
    settle(*globe_, kTimes);
  }
  void TearDown() override {
    globe_.reset();
    GlTest::TearDown();
  }
  [[nodiscard]] std::optional<UtcTime> shown() const { return globe_->layer_time(layer_)->shown; }

  /// Draws a frame, and checks that each pixel has the colour of the date that the layer says it shows.
  void draw_checked() {
    const auto before = shown();
    const FrameStats stats = draw(*globe_, kTimes);
    EXPECT_LE(double(stats.gpu_bytes_granted), 1.05 * double(globe_->options().gpu_bytes));
    std::set<std::uint8_t> blues;
    const std::vector<std::uint8_t> rgba = picture().rgba;
    for (std::size_t i = 0; i < rgba.size(); i += 4) blues.insert(rgba[i] == 200 ? rgba[i + 2] : std::uint8_t{0});
    ASSERT_THAT(blues, SizeIs(1)) << "mixed dates or holes";
    ASSERT_EQ(date(date_of(*blues.begin())), before) << "the date that is told is the one on the picture";
    ++frames_;
  }

  /// Goes through all dates and back to the first, `each` after the other. Returns the dates that were shown.
  std::set<int> play(milliseconds each) {
    std::set<int> dates;
    auto until = std::chrono::steady_clock::now();
    for (int k = 1; k <= kDates; ++k) {
      EXPECT_TRUE(globe_->set_layer_time(layer_, date(k % kDates)));
      until += each;
      while (std::chrono::steady_clock::now() < until && !HasFatalFailure()) {
        draw_checked();
        dates.insert(static_cast<int>((*shown() - date(0)) / std::chrono::days(1)));
        std::this_thread::sleep_for(milliseconds(8));
      }
    }
    return dates;
  }

  static inline std::unique_ptr<DatedServer> server_;
  ScratchFolder caches_;
  std::unique_ptr<Globe> globe_;
  LayerId layer_ = LayerId::none;
  int frames_ = 0;
};

TEST_F(LayerTimes, NoFrameMixesDatesAndTheSecondRoundAsksForNothing) {
  ASSERT_NO_FATAL_FAILURE(begin());
  const std::set<int> first = play(milliseconds(500));
  ASSERT_FALSE(HasFatalFailure());
  EXPECT_EQ(first.count(kMissing), 0U);
  EXPECT_GE(first.size(), std::size_t{kDates / 2}) << "a busy machine leaves out some, and the faults three";
  ASSERT_THAT(globe_->missing_instants(), SizeIs(1));
  EXPECT_EQ(globe_->missing_instants().front().instant, date(kMissing));
  EXPECT_THAT(globe_->missing_instants().front().why, HasSubstr("404"));
  const std::string asked = server_->asked();
  const std::set<int> second = play(milliseconds(100));
  EXPECT_EQ(server_->asked().substr(asked.size()), "") << "the second round asks for nothing";
  settle(*globe_, kTimes);
  EXPECT_EQ(shown(), date(0));
  std::printf("%d frames, %td requests, %zu and %zu dates shown\n", frames_, std::ranges::count(asked, '\n'),
              first.size(), second.size());
}

TEST_F(LayerTimes, AMissingDateIsTheOneBeforeIt) {
  ASSERT_NO_FATAL_FAILURE(begin());
  ASSERT_TRUE(globe_->set_layer_time(layer_, date(kMissing) + std::chrono::hours(5)));
  EXPECT_EQ(globe_->layer_time(layer_)->coming, date(kMissing));
  settle(*globe_, kTimes);
  draw_checked();
  EXPECT_EQ(shown(), date(kMissing - 1));
  EXPECT_FALSE(globe_->layer_time(layer_)->coming);
  ASSERT_THAT(globe_->missing_instants(), SizeIs(1));
  EXPECT_EQ(globe_->missing_instants().front().layer, layer_);
}

TEST_F(LayerTimes, ALateDateGivesWayToALaterWish) {
  ASSERT_NO_FATAL_FAILURE(begin());
  ASSERT_TRUE(globe_->set_layer_time(layer_, date(kLate)));
  draw_checked();
  ASSERT_TRUE(globe_->set_layer_time(layer_, date(3)));
  settle(*globe_, kTimes);
  EXPECT_EQ(shown(), date(3));
  const auto source = *globe_->source(layer_);
  ASSERT_TRUE(globe_->set_layer_time(layer_, date(3) + std::chrono::hours(23)));
  EXPECT_FALSE(globe_->awaits_source(layer_));
  EXPECT_EQ(*globe_->source(layer_), source) << "nothing happens for an instant that is shown";
}

TEST_F(LayerTimes, ADateThatIsLoadedAheadAppearsInTheNextFrame) {
  ASSERT_NO_FATAL_FAILURE(begin());
  settle(*globe_, kTimes);
  const auto before = shown();
  ASSERT_TRUE(globe_->load_layer_time(layer_, date(5)));
  settle(*globe_, kTimes);
  draw_checked();
  EXPECT_EQ(shown(), before) << "nobody has asked to see it";
  EXPECT_FALSE(globe_->awaits_source(layer_));
  const std::string asked = server_->asked();
  EXPECT_THAT(asked, HasSubstr(date_text(5)));
  ASSERT_TRUE(globe_->set_layer_time(layer_, date(5)));
  draw_checked();
  EXPECT_EQ(shown(), date(5));
  EXPECT_EQ(server_->asked(), asked);
  // The direction turns: what is late goes with the next wish, and nothing of it is shown or named.
  ASSERT_TRUE(globe_->load_layer_time(layer_, date(kLate)));
  draw_checked();
  ASSERT_TRUE(globe_->load_layer_time(layer_, date(4)));
  settle(*globe_, kTimes);
  ASSERT_TRUE(globe_->load_layer_time(layer_, std::nullopt));
  draw_checked();
  EXPECT_EQ(shown(), date(5));
  EXPECT_THAT(globe_->missing_instants(), IsEmpty());
}

TEST_F(LayerTimes, TheGlobesTimeChoosesTheDate) {
  ASSERT_NO_FATAL_FAILURE(begin());
  const auto show_at = [&](UtcTime time) {
    ASSERT_TRUE(globe_->set_time(time));
    settle(*globe_, kTimes);
  };
  ImageLook look;
  look.clock = LayerClock::globe;
  ASSERT_TRUE(globe_->set_look(layer_, look));
  settle(*globe_, kTimes);
  EXPECT_EQ(shown(), date(0)) << "a globe without a time leads no layer";
  for (const auto& [hours, day] : {std::pair{125, 5}, {143, 5}, {144, 6}, {47, 1}, {24 * kDates + 99, kDates - 1}}) {
    show_at(date(0) + std::chrono::hours(hours));
    draw_checked();
    EXPECT_EQ(shown(), date(day)) << hours;
  }
  EXPECT_THAT(globe_->set_layer_time(layer_, date(1)).error().message, HasSubstr("follows the globe's time"));
  EXPECT_THAT(globe_->load_layer_time(layer_, date(1)).error().message, HasSubstr("follows the globe's time"));
  // Before the first date the layer does not show.
  show_at(date(0) - std::chrono::hours(1));
  EXPECT_FALSE(shown());
  EXPECT_NE(picture().rgba[0], 200);
  show_at(date(2));
  draw_checked();
  EXPECT_EQ(shown(), date(2));
  // A missing date is asked for once, whatever the number of frames.
  show_at(date(kMissing) + std::chrono::hours(1));
  for (int k = 0; k < 3; ++k) show_at(date(kMissing) + std::chrono::hours(2 + k));
  draw_checked();
  EXPECT_EQ(shown(), date(kMissing - 1));
  EXPECT_THAT(globe_->missing_instants(), SizeIs(1));
  look.clock = LayerClock::own;
  ASSERT_TRUE(globe_->set_look(layer_, look));
  settle(*globe_, kTimes);
  EXPECT_TRUE(globe_->set_layer_time(layer_, date(1)));
  settle(*globe_, kTimes);
  EXPECT_EQ(shown(), date(1));
}

// The mean of two dates, weighted by the time, also where the layer is translucent: within a level of the pictures of
// the two dates alone.
TEST_F(LayerTimes, ADateFadesInOverTheOneBefore) {
  ASSERT_NO_FATAL_FAILURE(begin());
  ImageLook look;
  const auto pixel_at = [&](UtcTime time, LayerClock clock, double opacity) {
    look.clock = clock;
    look.opacity = opacity;
    EXPECT_TRUE(globe_->set_look(layer_, look));
    EXPECT_TRUE(globe_->set_time(time));
    settle(*globe_, kTimes);
    draw(*globe_, kTimes);
    const std::vector<std::uint8_t> rgba = picture().rgba;
    for (std::size_t i = 4; i < rgba.size(); ++i) EXPECT_NEAR(rgba[i], rgba[i - 4], 1) << "one colour everywhere";
    return std::array<double, 3>{double(rgba[0]), double(rgba[1]), double(rgba[2])};
  };
  for (const double opacity : {1.0, 0.5}) {
    const auto before = pixel_at(date(4), LayerClock::globe, opacity),
               after = pixel_at(date(5), LayerClock::globe, opacity);
    EXPECT_GE(after[2] - before[2], 3.0);
    for (const int hours : {0, 3, 6, 12, 18, 21, 23}) {
      const auto mean = pixel_at(date(4) + std::chrono::hours(hours), LayerClock::globe_fades, opacity);
      EXPECT_EQ(shown(), date(4));
      EXPECT_NEAR(globe_->layer_time(layer_)->next_share, hours / 24.0, 1e-9);
      EXPECT_EQ(globe_->layer_time(layer_)->next.has_value(), hours > 0);
      for (std::size_t k = 0; k < 3; ++k) {
        const double share = hours / 24.0;
        EXPECT_NEAR(mean[k], (1.0 - share) * before[k] + share * after[k], 1.0) << opacity << ' ' << hours << ' ' << k;
      }
    }
  }
  // A missing date does not fade in: nothing of the plain colour under it shows.
  EXPECT_EQ(pixel_at(date(kMissing - 1) + std::chrono::hours(20), LayerClock::globe_fades, 1.0),
            pixel_at(date(kMissing - 1), LayerClock::globe, 1.0));
  EXPECT_EQ(pixel_at(date(kMissing) + std::chrono::hours(12), LayerClock::globe, 1.0),
            pixel_at(date(kMissing - 1), LayerClock::globe, 1.0));
}

TEST_F(LayerTimes, AnswersSayWhatIsWrong) {
  ASSERT_NO_FATAL_FAILURE(begin());
  EXPECT_THAT(globe_->set_layer_time(LayerId{99}, date(1)).error().message, HasSubstr("Globe::set_layer_time"));
  EXPECT_THAT(globe_->set_layer_time(layer_, *parse_utc("2026-05-31")).error().message,
              HasSubstr("first time is 2026-06-01"));
  EXPECT_FALSE(globe_->layer_time(LayerId{99}));
  const LayerId still = *globe_->add_imagery(painted_tiles(TileGrid{}, [](const TileId&) { return Image{}; }));
  EXPECT_THAT(globe_->set_layer_time(still, date(1)).error().message, HasSubstr("no list of times"));
  EXPECT_FALSE(globe_->layer_time(still)->shown);
}

}  // namespace
}  // namespace terrella::test
