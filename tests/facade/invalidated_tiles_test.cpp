// Globe::invalidate() of one tile reads that tile again, whatever it was doing, and no other one.
#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <map>
#include <mutex>
#include <thread>

#include "tests/gl/gl_fixture.h"
#include "tiles/painted_tiles.h"

namespace terrella::test {
namespace {

constexpr Viewport kReread{64, 64};
constexpr int kReread_px = 16;
constexpr TileId kFirstRoot{.level = 0, .x = 0, .y = 0};

/// Paints every tile in the colour of the time at which it begins to be painted, and counts.
class Painter {
 public:
  [[nodiscard]] std::shared_ptr<TileSource> tiles(int max_level) {
    return painted_tiles({.tile_px = kReread_px, .max_level = max_level},
                         [this](const TileId& id) { return paint(id); });
  }
  void set_color(std::uint8_t grey) { grey_ = grey; }
  /// Painting of one tile waits as long as it is held.
  void hold(std::optional<TileId> held) {
    const std::lock_guard lock(mutex_);
    held_ = held;
    changed_.notify_all();
  }
  void wait_until_held() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_holding_; });
  }
  [[nodiscard]] std::map<TileId, int> counts() {
    const std::lock_guard lock(mutex_);
    return counts_;
  }

 private:
  Image paint(const TileId& id) {
    const std::uint8_t grey = grey_;
    std::unique_lock lock(mutex_);
    ++counts_[id];
    is_holding_ = is_holding_ || held_ == id;
    changed_.notify_all();
    changed_.wait(lock, [&] { return held_ != id; });
    std::vector<std::uint8_t> rgba(std::size_t{kReread_px} * kReread_px * 4, grey);
    for (std::size_t alpha = 3; alpha < rgba.size(); alpha += 4) rgba[alpha] = 255;
    return Image{kReread_px, kReread_px, std::move(rgba)};
  }

  std::atomic<std::uint8_t> grey_ = 255;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<TileId> held_;
  bool is_holding_ = false;
  std::map<TileId, int> counts_;
};

class InvalidatedTiles : public GlTest {
 protected:
  void begin(int max_level = 2) {
    GlobeOptions options = unlit_options();
    options.workers = 1;
    globe_ = make_globe(options, painter_.tiles(max_level));
    globe_->set_camera({.eye = {.lat = {}, .lon = Angle::degrees(-90.0), .height_m = 1.0e7}});
    draw(*globe_, kReread);
  }
  void invalidate(const TileId& id) { ASSERT_TRUE(globe_->invalidate(globe_->imagery().front(), id)); }
  void expect_each_once_but(const TileId& twice) {
    ASSERT_GT(painter_.counts().size(), 1U);
    for (const auto& [id, count] : painter_.counts()) {
      EXPECT_EQ(count, id == twice ? 2 : 1) << id.level << " " << id.x << " " << id.y;
    }
  }

  void TearDown() override {
    globe_.reset();
    GlTest::TearDown();
  }

  Painter painter_;
  std::unique_ptr<Globe> globe_;
};

// No frame takes the finished tiles before the call.
TEST_F(InvalidatedTiles, FinishedTilesStayBesideTheOneThatIsReadAgain) {
  begin();
  while (globe_->loading().waiting + globe_->loading().running > 0) std::this_thread::yield();
  ASSERT_GT(globe_->loading().finished, 1U);
  invalidate(kFirstRoot);
  settle(*globe_, kReread);
  expect_each_once_but(kFirstRoot);
}

TEST_F(InvalidatedTiles, ATileThatIsBeingReadIsReadAgain) {
  painter_.hold(kFirstRoot);
  painter_.set_color(80);
  begin(0);
  painter_.wait_until_held();
  painter_.set_color(200);
  invalidate(kFirstRoot);
  painter_.hold({});
  settle(*globe_, kReread);
  expect_each_once_but(kFirstRoot);
  EXPECT_EQ(picture().at(32, 32), (Color{200, 200, 200}));
}

TEST_F(InvalidatedTiles, ADrawnTileIsReadAgainAndDrawn) {
  begin();
  settle(*globe_, kReread);
  ASSERT_EQ(picture().at(32, 32), (Color{255, 255, 255}));
  painter_.set_color(120);
  std::optional<TileId> finest;
  for (const auto& [id, count] : painter_.counts()) finest = id;
  invalidate(*finest);
  settle(*globe_, kReread);
  expect_each_once_but(*finest);
}

}  // namespace
}  // namespace terrella::test
