// A swipe: layers that show on one side of a line. Judged by the same globe with the layers of one side alone.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/layer_source.h"
#include "tests/gl/painted_heights.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kSwiped{160, 120};
const TileGrid kSwipeGrid{.tile_px = 64, .max_level = 4};

std::uint8_t wave(double deg, double middle) {
  return static_cast<std::uint8_t>(std::lround(middle + 50.0 * std::sin(deg * M_PI / 30.0)));
}

LayerSource::Paint paint(double middle, std::uint8_t alpha) {
  return [middle, alpha](double lon, double row) {
    return Rgba{wave(lon, middle), wave(row, 120), wave(lon + row, 180 - middle), alpha};
  };
}

/// Straight down, a pole, ±180° with the limb, a tilted view.
std::vector<Camera> swipe_cameras() {
  return {camera_at(5, 20, 1.0e7), camera_at(90, 0, 3.0e6), camera_at(10, 180, 2.0e7),
          camera_at(40, 10, 4.0e5, 30, -20)};
}

class SwipeLine : public GlTest {
 protected:
  /// A base layer under two others, which a swipe compares.
  void make(const GlobeOptions& options) {
    auto made = Globe::create(options);
    ASSERT_TRUE(made);
    globe_ = std::move(*made);
    ASSERT_TRUE(globe_->add_imagery(std::make_shared<LayerSource>(kSwipeGrid, paint(120, 255))));
    first_ = add(paint(70, 255));
    second_ = add(paint(90, 160));
  }
  LayerId add(LayerSource::Paint painted) {
    const auto layer = globe_->add_imagery(std::make_shared<LayerSource>(kSwipeGrid, std::move(painted)));
    EXPECT_TRUE(layer);
    return layer ? *layer : LayerId::none;
  }
  void change(LayerId layer, const std::function<void(ImageLook&)>& how) {
    ImageLook look = *globe_->look(layer);
    how(look);
    ASSERT_TRUE(globe_->set_look(layer, look));
  }
  void set_line(std::optional<double> place) {
    SurfaceLook surface = globe_->options().surface;
    surface.swipe = place;
    globe_->set_surface(surface);
  }
  Picture shot() {
    settle(*globe_, kSwiped);
    return picture();
  }
  /// The picture with one of the two layers alone, without a line.
  Picture alone(LayerId shown) {
    set_line({});
    for (const LayerId layer : {first_, second_}) {
      change(layer, [&](ImageLook& look) { look.shown = layer == shown; });
    }
    const Picture seen = shot();
    for (const LayerId layer : {first_, second_}) change(layer, [](ImageLook& look) { look.shown = true; });
    return seen;
  }
  /// Pixels of the picture that differ from those of the layer of their side, by any level. The limb is antialiased
  /// with the ground of its neighbours, so where the line crosses it, a few pixels show that of the other side. `eyes`:
  /// pictures beside each other, each with its line.
  static int wrong(const Picture& swiped, const Picture& before, const Picture& behind, double place, int eyes) {
    constexpr int kNeighbours_px = 4;
    const int crossings = 2 * eyes, eye_px = kSwiped.width_px / eyes,
              line_px = static_cast<int>(std::round(place * eye_px));
    int beside = 0, others = 0;
    for (int y = 0; y < kSwiped.height_px; ++y) {
      for (int x = 0; x < kSwiped.width_px; ++x) {
        const int from_line_px = x % eye_px - line_px;
        if (swiped.at(x, y) == (from_line_px < 0 ? before : behind).at(x, y)) continue;
        ++(std::abs(from_line_px) <= kNeighbours_px ? beside : others);
      }
    }
    return beside <= crossings * kNeighbours_px ? others : beside + others;
  }
  void expect_sides(int eyes = 1) {
    for (const Camera& camera : swipe_cameras()) {
      SCOPED_TRACE(testing::Message() << camera.eye.lat.deg() << ' ' << camera.eye.height_m);
      globe_->set_camera(camera);
      const Picture before = alone(second_), behind = alone(first_);
      change(second_, [](ImageLook& look) { look.swipe = SwipeSide::before; });
      change(first_, [](ImageLook& look) { look.swipe = SwipeSide::behind; });
      for (const double place : {0.0, 0.3, 0.5, 1.0}) {
        set_line(place);
        EXPECT_EQ(wrong(shot(), before, behind, place, eyes), 0) << "line at " << place;
      }
      set_line(0.5);
      EXPECT_GT(wrong(shot(), behind, before, 0.5, eyes), 1000) << "both sides look alike";
      set_line({});
      for (const LayerId layer : {first_, second_}) {
        change(layer, [](ImageLook& look) { look.swipe = SwipeSide::both; });
      }
    }
  }
  std::unique_ptr<Globe> globe_;
  LayerId first_ = LayerId::none, second_ = LayerId::none;
};

TEST_F(SwipeLine, EachSideHasTheBytesOfItsLayerAlone) {
  make(unlit_options());
  expect_sides();
}

TEST_F(SwipeLine, InTheAirByDayAndNight) {
  GlobeOptions options;
  options.sky = true;
  options.time = *parse_utc("2026-03-20T12:30Z");
  make(options);
  expect_sides();
}

TEST_F(SwipeLine, OnRelief) {
  const auto heights = ElevationSource::open(
      painted_heights({.tile_px = 64, .max_level = 2},
                      [](double lat, double lon) { return 3000.0 * std::sin(20.0 * lat) * std::cos(20.0 * lon); }),
      "heights");
  ASSERT_TRUE(heights);
  make({});
  ASSERT_TRUE(globe_->set_elevation(*heights));
  expect_sides();
}

TEST_F(SwipeLine, EachEyeHasALineInItsPicture) {
  GlobeOptions options = unlit_options();
  options.stereo.mode = Stereo::side_by_side;
  make(options);
  expect_sides(2);
}

TEST_F(SwipeLine, OnATranslucentGlobe) {
  GlobeOptions options = unlit_options();
  options.surface.alpha = 0.6;
  make(options);
  expect_sides();
}

TEST_F(SwipeLine, TheLowestLayerMayHaveASide) {
  make(unlit_options());
  const LayerId base = globe_->imagery().front();
  for (const LayerId layer : {first_, second_}) change(layer, [](ImageLook& look) { look.shown = false; });
  globe_->set_camera(camera_at(5, 20, 1.0e7));
  const Picture whole = shot();
  change(base, [](ImageLook& look) { look.shown = false; });
  const Picture nothing = shot();
  change(base, [](ImageLook& look) {
    look.shown = true;
    look.swipe = SwipeSide::behind;
  });
  set_line(0.5);
  EXPECT_EQ(wrong(shot(), nothing, whole, 0.5, 1), 0);
}

TEST_F(SwipeLine, APixelIsOfTheLayerThatShowsThere) {
  make(unlit_options());
  globe_->set_camera(camera_at(5, 20, 3.0e6));
  change(second_, [](ImageLook& look) { look.swipe = SwipeSide::before; });
  set_line(0.3);
  shot();
  const double line_px = 0.3 * kSwiped.width_px;
  EXPECT_EQ(globe_->pick({line_px - 0.5, 60.0}, kSwiped).imagery, second_);
  EXPECT_EQ(globe_->pick({line_px + 0.5, 60.0}, kSwiped).imagery, first_);
  set_line({});
  EXPECT_EQ(globe_->pick({line_px + 0.5, 60.0}, kSwiped).imagery, second_);
}

TEST_F(SwipeLine, APlaceOutsideThePictureIsRefused) {
  make(unlit_options());
  set_line(1.5);
  ASSERT_FALSE(globe_->status());
  EXPECT_NE(globe_->status().error().message.find("swipe"), std::string::npos);
}

}  // namespace
}  // namespace terrella::test
