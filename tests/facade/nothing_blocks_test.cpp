// A source that is slow, or never answers, holds up nobody who no longer needs it.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <set>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/painted_heights.h"

namespace terrella::test {
namespace {

constexpr Viewport kSmall{64, 64};
const TileGrid kFew{.tile_px = 16, .max_level = 1};

/// State that a slow source shares with its test.
struct Gate {
  std::mutex mutex;
  std::condition_variable changed;
  bool is_open = false;
  int inside = 0;      ///< reads in progress
  int given_up = 0;    ///< reads that ended because they were told to stop
  bool freed = false;  ///< the source is gone

  template <class Condition>
  void wait(Condition condition) {
    std::unique_lock lock(mutex);
    // A test that hangs is worse than one that fails.
    EXPECT_TRUE(changed.wait_for(lock, std::chrono::seconds(30), condition));
  }
  void open() {
    const std::lock_guard lock(mutex);
    is_open = true;
    changed.notify_all();
  }
};

/// Each read waits for the gate, or, if the source obeys, until it is told to stop.
class SlowSource : public TileSource {
 public:
  SlowSource(std::shared_ptr<TileSource> tiles, std::shared_ptr<Gate> gate, bool obeys)
      : tiles_(std::move(tiles)), gate_(std::move(gate)), obeys_(obeys) {}
  ~SlowSource() override {
    const std::lock_guard lock(gate_->mutex);
    gate_->freed = true;
    gate_->changed.notify_all();
  }
  [[nodiscard]] const TileSetInfo& info() const override { return tiles_->info(); }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override { return tiles_->read(id); }
  [[nodiscard]] Result<EncodedTile, TileFailure> read_or_stop(const TileId& id, const std::stop_token& stop) override {
    const std::stop_callback told(stop, [this] { gate_->changed.notify_all(); });
    {
      std::unique_lock lock(gate_->mutex);
      ++gate_->inside;
      gate_->changed.notify_all();
      const auto may_go = [&] { return gate_->is_open || (obeys_ && stop.stop_requested()); };
      while (!may_go()) gate_->changed.wait_for(lock, std::chrono::milliseconds(20));
      --gate_->inside;
      if (!gate_->is_open) {
        ++gate_->given_up;
        return TileFailure{MissingKind::failed, "told to stop"};
      }
    }
    return tiles_->read(id);
  }

 private:
  std::shared_ptr<TileSource> tiles_;
  std::shared_ptr<Gate> gate_;
  bool obeys_;
};

class NothingBlocks : public GlTest {
 protected:
  static std::shared_ptr<TileSource> slow(std::shared_ptr<TileSource> tiles, std::shared_ptr<Gate> gate,
                                          bool obeys = false) {
    return std::make_shared<SlowSource>(std::move(tiles), std::move(gate), obeys);
  }
  static std::shared_ptr<TileSource> land() { return one_colour(kFew, {10, 200, 30}); }
  static std::shared_ptr<TileSource> hills() {
    return painted_heights(kFew, [](double lat, double) { return 1000.0 * lat; });
  }
  void wait_for_a_read(Globe& globe, Gate& gate) {
    draw(globe, kSmall);
    gate.wait([&] { return gate.inside > 0; });
  }
};

// The gate stays closed until the calls have returned, so a call that waited for the source would never return.
TEST_F(NothingBlocks, AGlobeALayerAndHeightsAreRemovedWhileTheirSourceReads) {
  for (const char* what : {"the globe", "the layer", "the elevation"}) {
    SCOPED_TRACE(what);
    const auto gate = std::make_shared<Gate>();
    const bool heights = std::string_view(what) == "the elevation";
    auto elevation = ElevationSource::open(heights ? slow(hills(), gate) : hills(), "heights");
    ASSERT_TRUE(elevation);
    auto globe = Globe::create(unlit_options(), heights ? land() : slow(land(), gate), *std::move(elevation));
    ASSERT_TRUE(globe) << globe.error().message;
    elevation = Error{"moved"};
    wait_for_a_read(**globe, *gate);
    if (heights) {
      EXPECT_TRUE((*globe)->set_elevation({}));
    } else if (std::string_view(what) == "the layer") {
      EXPECT_TRUE((*globe)->remove((*globe)->imagery().front()));
      EXPECT_EQ(settle(**globe, kSmall).tiles_pending, 0);
    } else {
      globe->reset();
    }
    {
      const std::lock_guard lock(gate->mutex);
      EXPECT_GT(gate->inside, 0) << "nothing was read any more: nothing was tested";
      EXPECT_FALSE(gate->freed) << "a source in use is gone";
    }
    gate->open();
    gate->wait([&] { return gate->freed; });  // by the worker, when it is done
  }
}

TEST_F(NothingBlocks, ReadsAreToldToStop) {
  const auto gate = std::make_shared<Gate>();
  auto globe = Globe::create(unlit_options(), slow(land(), gate, true));
  ASSERT_TRUE(globe) << globe.error().message;
  wait_for_a_read(**globe, *gate);
  globe->reset();
  gate->wait([&] { return gate->freed; });
  EXPECT_GT(gate->given_up, 0);
}

// Data that changed behind the source's back.
TEST_F(NothingBlocks, AnInvalidLayerIsReadAgainAndShowsTheEarlierTilesMeanwhile) {
  const auto level = std::make_shared<std::atomic<std::uint8_t>>(std::uint8_t{40});
  const auto source = std::make_shared<PaintedSource>(kFew, [level](double, double) { return Color{*level, 0, 0}; });
  const auto globe = make_globe(unlit_options(), source);
  const LayerId layer = globe->imagery().front();
  const auto middle = [&] { return int{picture().at(kSmall.width_px / 2, kSmall.height_px / 2)[0]}; };
  settle(*globe, kSmall);
  ASSERT_NEAR(middle(), 40, 3);  // JPEG

  *level = 200;
  source->hold();
  const int reads = source->reads();
  ASSERT_TRUE(globe->invalidate(layer));
  EXPECT_TRUE(globe->needs_frame());
  draw(*globe, kSmall);
  EXPECT_NEAR(middle(), 40, 3) << "the earlier tiles are gone";
  EXPECT_FALSE(globe->settled());
  source->release(1000);
  settle(*globe, kSmall);
  EXPECT_NEAR(middle(), 200, 3);
  const int again = source->reads() - reads;
  EXPECT_GT(again, 0);

  // One tile: one read.
  const int before = source->reads();
  *level = 120;
  ASSERT_TRUE(globe->invalidate(layer, TileId{.level = 0, .x = 0, .y = 0}));
  settle(*globe, kSmall);
  EXPECT_LE(source->reads() - before, 1);
  EXPECT_FALSE(globe->invalidate(static_cast<LayerId>(99)));
}

// Software drivers wait for the last frame when a program that it used is deleted.
TEST_F(NothingBlocks, ElevationGoesAndComesBackWithTheSamePrograms) {
  const auto programs = [] {
    std::set<GLuint> there;
    for (GLuint name = 1; name < 5000; ++name) {
      if (glIsProgram(name)) there.insert(name);
    }
    return there;
  };
  const auto heights = [] { return *ElevationSource::open(hills(), "hills"); };
  auto globe = Globe::create({}, land(), heights());
  ASSERT_TRUE(globe) << globe.error().message;
  settle(**globe, kSmall);
  const std::set<GLuint> raised = programs();
  EXPECT_FALSE(raised.empty());
  ASSERT_TRUE((*globe)->set_elevation({}));
  EXPECT_EQ(programs(), raised);
  settle(**globe, kSmall);
  const std::set<GLuint> both = programs();
  EXPECT_GT(both.size(), raised.size()) << "level ground has programs of its own";
  ASSERT_TRUE((*globe)->set_elevation(heights()));
  settle(**globe, kSmall);
  EXPECT_EQ(programs(), both) << "a program was made again";
}

// After a resize, or for another framebuffer, nothing has been drawn yet.
TEST_F(NothingBlocks, AnotherPictureNeedsAFrame) {
  const auto globe = make_globe(unlit_options(), land());
  settle(*globe, kSmall);
  const OffscreenTarget target(kSmall);
  globe->render(target.framebuffer(), kSmall);
  EXPECT_FALSE(globe->needs_frame());
  EXPECT_FALSE(globe->needs_frame(target.framebuffer(), kSmall));
  EXPECT_TRUE(globe->needs_frame(target.framebuffer(), {65, 64}));
  EXPECT_TRUE(globe->needs_frame(target.framebuffer() + 1, kSmall));
}

}  // namespace
}  // namespace terrella::test
