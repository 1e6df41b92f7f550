// Another source for an image layer: no frame shows tiles of both.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <set>
#include <thread>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/painted_heights.h"
#include "tests/scene/patch_test_support.h"
#include "tiles/painted_tiles.h"

namespace terrella::test {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

constexpr Viewport kSources{96, 96};
const TileGrid kSourceGrid{.tile_px = 64, .max_level = 5};

/// Tiles of one colour. Each takes its time, and those for which `lacks` is true are missing.
std::shared_ptr<TileSource> colored(std::uint8_t red, std::uint8_t blue, std::chrono::milliseconds takes = {},
                                    std::function<bool(const TileId&)> lacks = {}) {
  return painted_tiles(kSourceGrid, [=](const TileId& id) -> Result<Image, TileFailure> {
    std::this_thread::sleep_for(takes);
    if (lacks && lacks(id)) return TileFailure{MissingKind::absent, "no such date"};
    Image image{64, 64, {}};
    for (int k = 0; k < 64 * 64; ++k) {
      for (const std::uint8_t part : {red, std::uint8_t{40}, blue, std::uint8_t{255}}) image.rgba.push_back(part);
    }
    return image;
  });
}

class LayerSources : public GlTest {
 protected:
  void begin(GlobeOptions options = unlit_options()) {
    globe_ = *Globe::create(options);
    layer_ = *globe_->add_imagery(colored(200, 0));
    look(0);
    settle(*globe_, kSources);
  }
  void TearDown() override {
    globe_.reset();
    GlTest::TearDown();
  }
  /// Turns and comes nearer, so that each frame wants other tiles.
  void look(int step) {
    globe_->set_camera(camera_at(10.0 + 0.5 * step, 20.0 + 2.0 * step, 2.0e6 * std::pow(0.97, step)));
  }
  /// The colours of the ground, which fills the middle of a picture.
  [[nodiscard]] static std::set<std::pair<int, int>> colors_of(const std::vector<std::uint8_t>& rgba) {
    std::set<std::pair<int, int>> all;
    for (std::size_t y = 32; y < 64; ++y) {
      for (std::size_t x = 32; x < 64; ++x) all.emplace(rgba[4 * (96 * y + x)], rgba[4 * (96 * y + x) + 2]);
    }
    return all;
  }
  [[nodiscard]] std::set<std::pair<int, int>> colors() const { return colors_of(picture().rgba); }

  std::unique_ptr<Globe> globe_;
  LayerId layer_ = LayerId::none;
};

TEST_F(LayerSources, NoFrameMixesTwoDatesWhileTheEyeMoves) {
  begin();
  int step = 0, frames_before = 0;
  for (const std::uint8_t blue : std::array<std::uint8_t, 4>{50, 100, 150, 200}) {
    ASSERT_TRUE(globe_->set_source(layer_, colored(0, blue, std::chrono::milliseconds(3))));
    EXPECT_TRUE(globe_->awaits_source(layer_));
    for (int frame = 0; frame < 500 && globe_->awaits_source(layer_); ++frame) {
      look(++step % 40);
      draw(*globe_, kSources);
      EXPECT_THAT(colors(), SizeIs(1)) << "frame " << frame << " of date " << int(blue);
      EXPECT_FALSE(globe_->settled()) << "the new date is not on the screen";
      ++frames_before;
    }
    draw(*globe_, kSources);
    EXPECT_EQ(colors(), (std::set<std::pair<int, int>>{{0, blue}}));
  }
  EXPECT_GT(frames_before, 8) << "tiles came one after the other";
}

// Coarse tiles come first. Their green shows the level.
TEST_F(LayerSources, AStillPictureChangesInOneFrame) {
  begin();
  const auto leveled = [](std::uint8_t blue) {
    return painted_tiles(kSourceGrid, [blue](const TileId& id) {
      std::this_thread::sleep_for(std::chrono::milliseconds(4));
      Image image{64, 64, {}};
      for (int k = 0; k < 64 * 64; ++k) {
        for (const int part : {0, 40 * id.level, int(blue), 255}) image.rgba.push_back(static_cast<std::uint8_t>(part));
      }
      return image;
    });
  };
  ASSERT_TRUE(globe_->set_source(layer_, leveled(60)));
  settle(*globe_, kSources);
  const Picture first = picture();
  ASSERT_TRUE(globe_->set_source(layer_, leveled(160)));
  int frames_before = 0;
  while (globe_->awaits_source(layer_) && frames_before < 1000) {
    draw(*globe_, kSources);
    ASSERT_EQ(picture().rgba, first.rgba) << "frame " << frames_before;
    ++frames_before;
  }
  EXPECT_GT(frames_before, 3) << "tiles came one after the other";
  draw(*globe_, kSources);
  const Picture second = picture();
  EXPECT_NE(second.rgba, first.rgba);
  settle(*globe_, kSources);
  EXPECT_EQ(second.rgba, picture().rgba);
}

TEST_F(LayerSources, AStillPictureIsThatOfTheNewSourceAlone) {
  begin();
  const auto next = colored(0, 120);
  ASSERT_TRUE(globe_->set_source(layer_, next));
  EXPECT_NE(*globe_->source(layer_), next);
  settle(*globe_, kSources);
  const Picture shown = picture();
  EXPECT_EQ(*globe_->source(layer_), next);
  const auto other = make_globe(unlit_options(), colored(0, 120));
  other->set_camera(globe_->camera());
  settle(*other, kSources);
  EXPECT_EQ(shown.rgba, picture().rgba);
}

TEST_F(LayerSources, ALayerKeepsItsPlaceItsLookAndItsIdOverReliefAndOtherLayers) {
  begin();
  const auto hills = painted_heights(kSourceGrid, [](double lat, double) { return 4000.0 * std::sin(60.0 * lat); });
  ASSERT_TRUE(globe_->set_elevation(*ElevationSource::open(hills, "hills")));
  const LayerId above = *globe_->add_imagery(colored(0, 0), {.opacity = 0.5});
  ASSERT_TRUE(globe_->set_source(above, colored(0, 200)));
  ASSERT_TRUE(globe_->set_source(layer_, colored(100, 0)));
  settle(*globe_, kSources);
  EXPECT_EQ(globe_->imagery(), (std::vector<LayerId>{layer_, above}));
  EXPECT_EQ(globe_->look(above)->opacity, 0.5);
  for (const auto& [red, blue] : colors()) {
    EXPECT_NEAR(red, 50, 1);
    EXPECT_NEAR(blue, 100, 1);
  }
}

TEST_F(LayerSources, TheLastOfSeveralSourcesIsShown) {
  begin();
  ASSERT_TRUE(globe_->set_source(layer_, colored(0, 50, std::chrono::milliseconds(20))));
  draw(*globe_, kSources);
  ASSERT_TRUE(globe_->set_source(layer_, colored(0, 150)));
  settle(*globe_, kSources);
  EXPECT_EQ(colors(), (std::set<std::pair<int, int>>{{0, 150}}));
  EXPECT_FALSE(globe_->awaits_source(layer_));
}

TEST_F(LayerSources, ASourceWithoutATileInViewIsNotShown) {
  begin();
  const auto shown = *globe_->source(layer_);
  ASSERT_TRUE(globe_->set_source(layer_, colored(0, 50, {}, [](const TileId&) { return true; })));
  settle(*globe_, kSources);
  EXPECT_EQ(colors(), (std::set<std::pair<int, int>>{{200, 0}}));
  EXPECT_FALSE(globe_->awaits_source(layer_));
  EXPECT_EQ(*globe_->source(layer_), shown);
  ASSERT_THAT(globe_->missing_tiles(), testing::Not(testing::IsEmpty()));
  EXPECT_THAT(globe_->missing_tiles().front().failure.why, HasSubstr("no such date"));
}

TEST_F(LayerSources, OfAHiddenLayerIsInPlaceAtOnce) {
  begin();
  ASSERT_TRUE(globe_->set_look(layer_, {.shown = false}));
  ASSERT_TRUE(globe_->set_source(layer_, colored(0, 90)));
  EXPECT_FALSE(globe_->awaits_source(layer_));
  ASSERT_TRUE(globe_->set_look(layer_, {}));
  settle(*globe_, kSources);
  EXPECT_EQ(colors(), (std::set<std::pair<int, int>>{{0, 90}}));
}

TEST_F(LayerSources, AViewBesideShowsEitherSourceToo) {
  begin();
  const auto overview = *GlobeView::create(*globe_);
  overview->set_camera(camera_at(-20, 100, 9.0e6));
  OffscreenTarget target(kSources);
  const auto draw_both = [&] {
    draw(*globe_, kSources);
    overview->render(target.framebuffer(), kSources);
    EXPECT_THAT(colors(), SizeIs(1));
    EXPECT_THAT(colors_of(target.read()), SizeIs(1));
  };
  for (int frame = 0; frame < 200 && !overview->settled(); ++frame) draw_both();
  ASSERT_TRUE(globe_->set_source(layer_, colored(0, 70, std::chrono::milliseconds(2))));
  for (int frame = 0; frame < 500 && globe_->awaits_source(layer_); ++frame) draw_both();
  EXPECT_FALSE(globe_->awaits_source(layer_));
  EXPECT_TRUE(globe_->needs_frame() || overview->needs_frame());
  draw_both();
  EXPECT_EQ(colors(), (std::set<std::pair<int, int>>{{0, 70}}));
  EXPECT_EQ(colors_of(target.read()), colors());
}

TEST_F(LayerSources, AnswersSayWhatIsWrong) {
  begin();
  EXPECT_THAT(globe_->set_source(LayerId{99}, colored(0, 1)).error().message, HasSubstr("Globe::set_source"));
  EXPECT_THAT(globe_->set_source(layer_, nullptr).error().message, HasSubstr("there is no source"));
  EXPECT_FALSE(globe_->source(LayerId{99}));
  ASSERT_TRUE(globe_->set_source(layer_, colored(0, 50, std::chrono::milliseconds(5))));
  draw(*globe_, kSources);
  EXPECT_TRUE(globe_->remove(layer_));
  settle(*globe_, kSources);
  EXPECT_FALSE(globe_->awaits_source(layer_));
}

}  // namespace
}  // namespace terrella::test
