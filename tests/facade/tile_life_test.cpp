// Imagery and heights live one life: what fails for now is retried, and a wait costs nothing, whichever kind it is for.
#include <gtest/gtest.h>

#include <ctime>
#include <functional>
#include <mutex>
#include <set>
#include <thread>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/painted_heights.h"

namespace terrella::test {
namespace {

using std::chrono::steady_clock;

constexpr Viewport kPicture{128, 128};
constexpr Color kLand = {200, 180, 90};
constexpr auto kPatience = std::chrono::seconds(60);  // a loaded machine with software GL
const TileGrid kFourLevels{.tile_px = 64, .max_level = 4};

/// Another source, with something done before each read.
class Interposed : public TileSource {
 public:
  using Before = std::function<std::optional<TileFailure>(const TileId&)>;
  Interposed(std::shared_ptr<TileSource> tiles, Before before) : tiles_(std::move(tiles)), before_(std::move(before)) {}
  [[nodiscard]] const TileSetInfo& info() const override { return tiles_->info(); }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (const auto failure = before_(id)) return *failure;
    return tiles_->read(id);
  }

 private:
  std::shared_ptr<TileSource> tiles_;
  Before before_;
};

/// The first read of each tile fails as a server does that answers 503.
std::shared_ptr<TileSource> failing_once(std::shared_ptr<TileSource> tiles) {
  auto seen = std::make_shared<std::pair<std::mutex, std::set<TileId>>>();
  return std::make_shared<Interposed>(std::move(tiles), [seen](const TileId& id) -> std::optional<TileFailure> {
    const std::lock_guard lock(seen->first);
    if (!seen->second.insert(id).second) return std::nullopt;
    return TileFailure{MissingKind::failed, "status 503"};
  });
}

std::shared_ptr<TileSource> slow(std::shared_ptr<TileSource> tiles, std::chrono::milliseconds delay) {
  return std::make_shared<Interposed>(std::move(tiles), [delay](const TileId&) {
    std::this_thread::sleep_for(delay);
    return std::optional<TileFailure>();
  });
}

std::shared_ptr<TileSource> hills() {
  return painted_heights(kFourLevels,
                         [](double lat, double lon) { return 2000.0 * std::sin(9.0 * lat) * std::cos(5.0 * lon); });
}

ElevationSource elevation(std::shared_ptr<TileSource> tiles) {
  auto source = ElevationSource::open(std::move(tiles), "heights");
  EXPECT_TRUE(source) << source.error().message;
  return *std::move(source);
}

Camera over_hills() { return {.eye = {.lat = Angle::degrees(20), .lon = Angle::degrees(15), .height_m = 2.0e6}}; }

std::unique_ptr<Globe> globe_of(const GlobeOptions& options, std::shared_ptr<TileSource> imagery,
                                std::shared_ptr<TileSource> heights) {
  auto globe = Globe::create(options, std::move(imagery), elevation(std::move(heights)));
  EXPECT_TRUE(globe) << globe.error().message;
  (*globe)->set_camera(over_hills());
  return *std::move(globe);
}

double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

class TileLife : public GlTest {
 protected:
  /// Frames as a window draws them, until `done`; false if that takes too long.
  bool frames_until(Globe& globe, const std::function<bool(const FrameStats&)>& done) {
    for (const auto deadline = steady_clock::now() + kPatience; steady_clock::now() < deadline;) {
      if (globe.needs_frame() && done(draw(globe, kPicture))) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }
};

TEST_F(TileLife, TilesThatFailForNowAreRequestedAgainWhateverTheirKind) {
  const auto wants_nothing = [](const FrameStats& stats) {
    return stats.tiles_pending + stats.tiles_missing + stats.heights_pending + stats.heights_missing == 0 &&
           !stats.heights_arrived;
  };
  GlobeOptions options = unlit_options();
  options.retry_after = std::chrono::milliseconds(200);
  const auto spoiled = globe_of(options, failing_once(one_colour(kFourLevels, kLand)), failing_once(hills()));
  int missing = 0;
  EXPECT_TRUE(frames_until(*spoiled, [&](const FrameStats& stats) {
    missing = std::max(missing, stats.heights_missing);
    return spoiled->settled() && wants_nothing(stats);
  })) << "tiles stay missing";
  EXPECT_GT(missing, 0) << "no tile of heights has failed: nothing was tested";
  const auto recovered = picture().rgba;
  const auto whole = globe_of(unlit_options(), one_colour(kFourLevels, kLand), hills());
  settle(*whole, kPicture);
  EXPECT_EQ(recovered, picture().rgba);
}

TEST_F(TileLife, AWaitForTilesTakesNoProcessorTimeWhateverTheirKind) {
  const auto picture_of = [this](std::shared_ptr<TileSource> imagery, std::shared_ptr<TileSource> heights) {
    const auto globe = globe_of(unlit_options(), std::move(imagery), std::move(heights));
    draw(*globe, kPicture);  // compiles what the driver puts off to the first frame
    const double before = processor_s();
    const auto start = steady_clock::now();
    settle(*globe, kPicture);
    const double wall = std::chrono::duration<double>(steady_clock::now() - start).count();
    return std::pair{processor_s() - before, wall};
  };
  const auto [slow_heights, heights_wall] =
      picture_of(one_colour(kFourLevels, kLand), slow(hills(), std::chrono::milliseconds(250)));
  const auto [slow_imagery, imagery_wall] =
      picture_of(slow(one_colour(kFourLevels, kLand), std::chrono::milliseconds(1000)), hills());
  // A frame of this size takes some 10 ms of processor time: one for each tile that comes is a small part of the wait.
  EXPECT_GT(heights_wall, 2.0) << "too few tiles to wait for";
  EXPECT_LT(slow_heights, 0.3 * heights_wall);
  EXPECT_GT(imagery_wall, 1.0);
  EXPECT_LT(slow_imagery, 0.3 * imagery_wall);
}

}  // namespace
}  // namespace terrella::test
