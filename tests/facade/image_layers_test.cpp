// Image layers over each other, judged pixel by pixel against what each of them is alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/layer_source.h"
#include "tests/gl/painted_heights.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kLayered{96, 96};
// A level for the rounding of each of two blends.
constexpr int kRounding = 1;
// Alpha in eight bits and three blends one after another.
constexpr int kManyRoundings = 3;

TileGrid two_roots() { return {.tile_px = 64, .max_level = 4}; }
TileGrid one_root() { return {.root_span_deg = 360.0, .tile_px = 32, .max_level = 6}; }

std::uint8_t wave(double deg, double middle, double phase) {
  return static_cast<std::uint8_t>(std::lround(middle + 60.0 * std::sin(deg * (3.14159265 / 180.0) * 2.0 + phase)));
}
Rgba cool(double lon, double row) { return {wave(lon, 70, 0.0), wave(row, 90, 1.0), wave(lon, 170, 2.0), 255}; }
Rgba warm(double lon, double row) { return {wave(row, 180, 0.3), wave(lon, 120, 1.4), wave(row, 80, 2.9), 255}; }

/// Looking at the equator, both poles, the antimeridian, and near enough for tiles of several levels.
std::vector<Camera> layer_cameras() {
  return {camera_at(5, 20, 1.0e7), camera_at(90, 0, 6.0e6), camera_at(-90, 0, 2.0e6), camera_at(2, 180, 1.5e6, 30, -60),
          camera_at(40, -179.9, 3.0e5)};
}

/// The part of a channel that is off by most, over all pixels: `blend` of what the pictures have there.
template <class Blend>
int worst(const Picture& got, const Picture& a, const Picture& b, Blend blend) {
  double most = 0.0;
  for (std::size_t k = 0; k < got.rgba.size(); ++k) {
    if (k % 4 == 3) continue;
    most = std::max(most, std::abs(got.rgba[k] - blend(double(a.rgba[k]), double(b.rgba[k]))));
  }
  return static_cast<int>(std::ceil(most - 0.501));
}

int differing(const Picture& a, const Picture& b) {
  return worst(a, b, b, [](double x, double) { return x; });
}

class ImageLayers : public GlTest {
 protected:
  static std::shared_ptr<TileSource> painted(const TileGrid& grid, LayerSource::Paint paint,
                                             LayerSource::Lacks lacks = {}) {
    return std::make_shared<LayerSource>(grid, std::move(paint), std::move(lacks));
  }
  /// As if there were nothing else.
  Picture alone(Globe& globe, LayerId layer) {
    std::vector<std::pair<LayerId, ImageLook>> before;
    for (const LayerId id : globe.imagery()) {
      before.emplace_back(id, *globe.look(id));
      ImageLook look = before.back().second;
      look.shown = id == layer;
      look.opacity = 1.0;
      EXPECT_TRUE(globe.set_look(id, look));
    }
    Picture shown = settled(globe);
    for (const auto& [id, look] : before) EXPECT_TRUE(globe.set_look(id, look));
    return shown;
  }
  Picture settled(Globe& globe) {
    settle(globe, kLayered);
    return picture();
  }
  std::unique_ptr<Globe> empty_globe(const GlobeOptions& options = unlit_options()) {
    auto globe = Globe::create(options);
    EXPECT_TRUE(globe);
    return globe ? std::move(*globe) : nullptr;
  }
};

TEST_F(ImageLayers, WithoutAnyTheBodyHasAPlainColour) {
  const auto globe = empty_globe();
  globe->set_camera(camera_at(0, 0, 1.0e6));
  draw(*globe, kLayered);
  EXPECT_TRUE(globe->settled());
  const Picture plain = picture();
  EXPECT_EQ(plain.at(48, 48), (Color{30, 38, 52}));
  EXPECT_EQ(plain.at(2, 2), plain.at(48, 48));
}

TEST_F(ImageLayers, HalfOpaqueIsHalfOfEachAtPolesAndTheAntimeridian) {
  for (const bool wide_below : {false, true}) {
    const auto globe = empty_globe();
    const auto below = globe->add_imagery(painted(wide_below ? one_root() : two_roots(), cool));
    const auto above = globe->add_imagery(painted(wide_below ? two_roots() : one_root(), warm), {.opacity = 0.5});
    ASSERT_TRUE(below && above);
    for (const Camera& camera : layer_cameras()) {
      globe->set_camera(camera);
      const Picture lower = alone(*globe, *below), upper = alone(*globe, *above), both = settled(*globe);
      EXPECT_GT(differing(lower, upper), 40);
      EXPECT_LE(worst(both, lower, upper, [](double x, double y) { return 0.5 * x + 0.5 * y; }), kRounding);
    }
  }
}

TEST_F(ImageLayers, EqualAreaRowsAndPlanetocentricLatitudesLieOverOthers) {
  TileGrid other = two_roots();
  other.projection = Projection::equal_area;
  other.latitude = LatitudeKind::centric;
  GlobeOptions options = unlit_options();
  options.body.ellipsoid = Ellipsoid(6378137.0, 0.1);
  const auto globe = empty_globe(options);
  const auto below = globe->add_imagery(painted(two_roots(), cool));
  const auto above = globe->add_imagery(painted(other, warm), {.opacity = 0.5});
  ASSERT_TRUE(below && above);
  for (const Camera& camera : {camera_at(5, 20, 1.0e7), camera_at(60, 180, 2.0e6, 30, -60)}) {
    globe->set_camera(camera);
    const Picture lower = alone(*globe, *below), upper = alone(*globe, *above), both = settled(*globe);
    EXPECT_LE(worst(both, lower, upper, [](double x, double y) { return 0.5 * x + 0.5 * y; }), kRounding + 1);
  }
}

TEST_F(ImageLayers, OrderHidingAndRemoval) {
  const auto globe = empty_globe();
  globe->set_camera(camera_at(10, 30, 5.0e6));
  const LayerId first = *globe->add_imagery(painted(two_roots(), cool));
  const LayerId second = *globe->add_imagery(painted(one_root(), warm));
  const Picture lower = alone(*globe, first), upper = alone(*globe, second);
  EXPECT_EQ(differing(settled(*globe), upper), 0);
  ASSERT_TRUE(globe->move(second, 0));
  EXPECT_EQ(globe->imagery(), (std::vector{second, first}));
  EXPECT_EQ(differing(settled(*globe), lower), 0);
  ASSERT_TRUE(globe->set_look(first, {.shown = false}));
  EXPECT_EQ(differing(settled(*globe), upper), 0);
  ASSERT_TRUE(globe->set_look(first, {.opacity = 0.0}));
  EXPECT_EQ(differing(settled(*globe), upper), 0);
  ASSERT_TRUE(globe->set_look(first, {}));
  ASSERT_TRUE(globe->remove(second));
  EXPECT_EQ(differing(settled(*globe), lower), 0);
  EXPECT_EQ(globe->imagery(), std::vector{first});
}

TEST_F(ImageLayers, AHoleShowsWhatLiesUnderIt) {
  const auto globe = empty_globe();
  globe->set_camera(camera_at(0, 0, 1.2e7));
  const LayerId below = *globe->add_imagery(painted(two_roots(), cool));
  TileGrid bounded = two_roots();
  bounded.bounds = {.west = Angle::degrees(0.0),
                    .south = Angle::degrees(-90.0),
                    .east = Angle::degrees(180.0),
                    .north = Angle::degrees(90.0)};
  const LayerSource::Paint clear_west = [](double lon, double row) {
    return lon < 0.0 ? Rgba{255, 255, 255, 0} : warm(lon, row);
  };
  // Holes of three kinds: transparent texels, tiles that the source lacks, tiles beyond its bounds.
  const auto lacks_west = [](const TileId& id) { return id.x < std::int64_t{1} << id.level; };
  for (const auto& source :
       {painted(two_roots(), clear_west), painted(two_roots(), warm, lacks_west), painted(bounded, warm)}) {
    const LayerId above = *globe->add_imagery(source);
    const Picture lower = alone(*globe, below), both = settled(*globe);
    for (int y = 10; y < 86; ++y) {
      for (int x = 30; x < 46; ++x) EXPECT_EQ(both.at(x, y), lower.at(x, y)) << x << ' ' << y;
    }
    int covered = 0;
    for (int x = 50; x < 66; ++x) covered += both.at(x, 48) != lower.at(x, 48) ? 1 : 0;
    EXPECT_GT(covered, 14);
    ASSERT_TRUE(globe->remove(above));
  }
}

TEST_F(ImageLayers, AlphaOfTilesBlendsEvenWhereNothingLiesUnderThem) {
  const auto globe = empty_globe();
  globe->set_camera(camera_at(0, 0, 5.0e6));
  const Picture plain = settled(*globe);
  const LayerId glass = *globe->add_imagery(painted(two_roots(),
                                                    [](double, double) {
                                                      return Rgba{200, 40, 0, 128};
                                                    }),
                                            {.opacity = 0.75});
  const Picture tinted = settled(*globe);
  constexpr double kShare = 128.0 / 255.0 * 0.75;
  const Color under = plain.at(48, 48), over = tinted.at(48, 48);
  EXPECT_NEAR(over[0], kShare * 200 + (1 - kShare) * under[0], kRounding + 0.5);
  EXPECT_NEAR(over[1], kShare * 40 + (1 - kShare) * under[1], kRounding + 0.5);
  EXPECT_NEAR(over[2], (1 - kShare) * under[2], kRounding + 0.5);
  EXPECT_TRUE(globe->remove(glass));
}

TEST_F(ImageLayers, ATranslucentSurfaceIsThatOfItsLayersTogether) {
  for (const Blend blend : {Blend::normal, Blend::additive}) {
    GlobeOptions options = unlit_options();
    const auto globe = empty_globe(options);
    globe->set_camera(camera_at(5, 20, 1.0e7));
    ASSERT_TRUE(globe->add_imagery(painted(two_roots(), cool)));
    ASSERT_TRUE(globe->add_imagery(painted(one_root(), warm), {.opacity = 0.4}));
    ASSERT_TRUE(globe->add_imagery(painted(two_roots(), [](double lon, double) {
      return lon > 25.0 ? Rgba{0, 0, 0, 0} : Rgba{20, 200, 60, 180};
    })));
    const PointObject ball{.place = {.lat = Angle::degrees(5.0), .lon = Angle::degrees(20.0), .height_m = -9.0e5},
                           .radius_m = 5.0e5,
                           .color = {220, 90, 30}};
    ASSERT_TRUE(globe->add_objects({.points = {ball}}));
    const auto look = [&](double alpha) {
      globe->set_surface({.alpha = alpha, .blend = blend});
      return settled(*globe);
    };
    const Picture opaque = look(1.0), below = look(0.0), both = look(0.6);
    const double keeps = blend == Blend::normal ? 0.4 : 1.0;
    EXPECT_LE(worst(both, opaque, below, [&](double x, double y) { return std::min(255.0, 0.6 * x + keeps * y); }),
              kManyRoundings);
    for (std::size_t k = 3; k < both.rgba.size(); k += 4) ASSERT_EQ(both.rgba[k], 255);
  }
}

TEST_F(ImageLayers, HeightsComeAndGoUnderLayersOfDifferentRows) {
  TileGrid other = two_roots();
  other.projection = Projection::equal_area;
  const auto heights = ElevationSource::open(
      painted_heights({.tile_px = 64, .max_level = 2},
                      [](double lat, double lon) { return 3000.0 * std::sin(20.0 * lat) * std::cos(20.0 * lon); }),
      "heights");
  ASSERT_TRUE(heights);
  const auto globe = empty_globe();
  globe->set_exaggeration(20.0);
  globe->set_camera(camera_at(30, 10, 1.5e6, 40, -50));
  const auto below = globe->add_imagery(painted(one_root(), cool));
  const auto above = globe->add_imagery(painted(other, warm), {.opacity = 0.5});
  ASSERT_TRUE(below && above);
  const Picture flat = settled(*globe);
  ASSERT_TRUE(globe->set_elevation(*heights));
  EXPECT_TRUE(globe->has_relief());
  EXPECT_TRUE(globe->needs_frame());
  const Picture lower = alone(*globe, *below), upper = alone(*globe, *above), both = settled(*globe);
  EXPECT_GT(std::abs(globe->ground_height_m(Angle::degrees(31.5), Angle::degrees(9.0))), 1000.0);
  EXPECT_GT(differing(both, flat), 20);
  EXPECT_LE(worst(both, lower, upper, [](double x, double y) { return 0.5 * x + 0.5 * y; }), kRounding + 1);
  const Ground before = globe->ground();
  const double height_m = before.height_m(Angle::degrees(31.5), Angle::degrees(9.0));
  ASSERT_TRUE(globe->set_elevation({}));
  EXPECT_EQ(globe->ground_height_m(Angle::degrees(31.5), Angle::degrees(9.0)), 0.0);
  EXPECT_EQ(before.height_m(Angle::degrees(31.5), Angle::degrees(9.0)), height_m) << "a Ground outlives the elevation";
  EXPECT_EQ(differing(settled(*globe), flat), 0);
}

TEST_F(ImageLayers, LevelsOutsideTheRangeAreNotDrawn) {
  const auto globe = empty_globe();
  ASSERT_TRUE(globe->add_imagery(painted(two_roots(), cool)));
  const LayerId near = *globe->add_imagery(painted(two_roots(), warm), {.min_level = 3});
  const auto shows_it = [&](double height_m) {
    globe->set_camera(camera_at(0, 0, height_m));
    const Picture with = settled(*globe);
    EXPECT_TRUE(globe->set_look(near, {.shown = false}));
    const Picture without = settled(*globe);
    EXPECT_TRUE(globe->set_look(near, {.min_level = 3}));
    return differing(with, without) > 20;
  };
  EXPECT_TRUE(shows_it(1.0e6));
  EXPECT_FALSE(shows_it(3.0e7));
  const auto reads = [&](int max_level) {
    const auto counted = std::make_shared<PaintedSource>(
        two_roots(),
        [](double, double) {
          return Color{1, 2, 3};
        },
        [](const TileId& id) { return id.level > 2; });
    EXPECT_TRUE(globe->add_imagery(counted, {.max_level = max_level}));
    globe->set_camera(camera_at(0, 0, 1.0e6));
    settle(*globe, kLayered);
    return std::pair(globe->loading().missing, counted->reads());
  };
  EXPECT_EQ(reads(2).first, 0U);
  EXPECT_GT(reads(4).first, 0U);
}

TEST_F(ImageLayers, LayersShareTheBudgetAndItCanChange) {
  const auto globe = empty_globe();
  globe->set_camera(camera_at(40, 20, 3.0e5));
  const LayerId below = *globe->add_imagery(painted(two_roots(), cool));
  ASSERT_TRUE(globe->add_imagery(painted(one_root(), warm), {.opacity = 0.5}));
  const Picture rich = settled(*globe);
  GlobeBudget budget{.gpu_bytes = 1UL << 20,
                     .upload_bytes_per_frame = 1UL << 20,
                     .upload_time_per_frame = std::chrono::microseconds(1000),
                     .relief_meshes_per_frame = 4};
  globe->set_budget(budget);
  settle(*globe, kLayered);
  EXPECT_EQ(globe->options().gpu_bytes, budget.gpu_bytes);
  budget.gpu_bytes = 256UL << 20;
  globe->set_budget(budget);
  EXPECT_EQ(differing(settled(*globe), rich), 0);
  EXPECT_TRUE(globe->remove(below));
}

TEST_F(ImageLayers, AFrameIsNeededWhenSomethingChanged) {
  const auto globe = empty_globe();
  int told = 0;
  globe->on_settled([&told] { ++told; });
  const LayerId layer = *globe->add_imagery(painted(two_roots(), cool));
  EXPECT_TRUE(globe->needs_frame());
  settle(*globe, kLayered);
  EXPECT_EQ(told, 1);
  EXPECT_FALSE(globe->needs_frame());
  globe->set_camera(globe->camera());
  EXPECT_FALSE(globe->needs_frame());
  globe->set_camera(camera_at(20, 20, 3.0e5));
  EXPECT_TRUE(globe->needs_frame());
  settle(*globe, kLayered);
  EXPECT_EQ(told, 2);
  EXPECT_FALSE(globe->needs_frame());
  EXPECT_TRUE(globe->set_look(layer, {.opacity = 0.5}));
  EXPECT_TRUE(globe->needs_frame());
}

}  // namespace
}  // namespace terrella::test
