// Blends of layers with the layers below. Judged by the formulas of LayerBlend, computed here from the layers' colours,
// and in light and air by tiles that were painted with the blended colours.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "globe/experiments.h"
#include "tests/gl/gl_fixture.h"
#include "tests/gl/layer_source.h"
#include "tests/gl/painted_heights.h"
#include "tests/gl/painted_numbers.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kBlended{64, 64};
const TileGrid kBlendGrid{.tile_px = 64, .max_level = 3};
const TileGrid kOtherRows{.tile_px = 64, .max_level = 3, .projection = Projection::equal_area};
constexpr Rgba kBelow{200, 90, 30, 255}, kOwn{120, 60, 220, 255}, kOwnGlass{120, 60, 220, 128};
constexpr LayerBlend kBlends[] = {LayerBlend::multiply, LayerBlend::screen, LayerBlend::difference};
constexpr int kLevel = 1;        // one of eight bits
constexpr int kGlassLevels = 2;  // tiles with alpha are stored premultiplied, in eight bits
// Light, and air by squares, make levels of the picture below coarser; the painted layer has a rounding of its own.
constexpr int kLitLevels = 2;
// Before bright haze a level of the picture below is several levels of dark ground.
constexpr int kHazeLevels = 8;
constexpr double kMostHazy = 0.01;

using Part = std::array<double, 3>;

double blended(double below, double own, LayerBlend blend) {
  if (blend == LayerBlend::multiply) return below * own;
  if (blend == LayerBlend::screen) return 1.0 - (1.0 - below) * (1.0 - own);
  return blend == LayerBlend::difference ? std::max(below, own) - std::min(below, own) : own;
}

/// A picture of one colour after a layer of another.
Part after(const Part& below, const Rgba& own, double opacity, LayerBlend blend) {
  const double share = opacity * own[3] / 255.0;
  Part sum = below;
  for (std::size_t k = 0; k < 3; ++k) sum[k] += share * (blended(below[k], own[k] / 255.0, blend) - below[k]);
  return sum;
}

Part part_of(const Rgba& color) { return {color[0] / 255.0, color[1] / 255.0, color[2] / 255.0}; }

Rgba rounded(const Part& part) {
  const auto byte = [](double value) { return static_cast<std::uint8_t>(std::lround(255.0 * value)); };
  return {byte(part[0]), byte(part[1]), byte(part[2]), 255};
}

class Blends : public GlTest {
 protected:
  static LayerId add(Globe& globe, const Rgba& color, const ImageLook& look = {}, const TileGrid& grid = kBlendGrid) {
    const auto added =
        globe.add_imagery(std::make_shared<LayerSource>(grid, [color](double, double) { return color; }), look);
    EXPECT_TRUE(added) << (added ? "" : added.error().message);
    return added ? *added : LayerId::none;
  }
  static std::unique_ptr<Globe> globe_of(const GlobeOptions& options) {
    auto globe = Globe::create(options);
    EXPECT_TRUE(globe);
    return globe ? std::move(*globe) : nullptr;
  }
  Picture shot(Globe& globe, const Camera& camera = camera_at(5, 20, 1.0e6)) {
    globe.set_camera(camera);
    settle(globe, kBlended);
    return picture();
  }
  /// The largest difference of a pixel from one colour.
  static double farthest(const Picture& seen, const Part& wanted) {
    double most = 0.0;
    for (std::size_t k = 0; k < seen.rgba.size(); ++k) {
      if (k % 4 < 3) most = std::max(most, std::abs(seen.rgba[k] - 255.0 * wanted[k % 4]));
    }
    return most;
  }
  static double farthest(const Picture& a, const Picture& b) {
    int most = 0;
    for (std::size_t k = 0; k < a.rgba.size(); ++k) most = std::max(most, std::abs(int{a.rgba[k]} - int{b.rgba[k]}));
    return most;
  }
  /// The largest difference from the formula over a picture.
  static double farthest_blend(const Picture& seen, const Picture& below, const Rgba& own, double opacity,
                               LayerBlend blend) {
    double most = 0.0;
    for (std::size_t k = 0; k < seen.rgba.size(); ++k) {
      if (k % 4 == 3) continue;
      Part under{};
      under[k % 4] = below.rgba[k] / 255.0;
      most = std::max(most, std::abs(seen.rgba[k] - 255.0 * after(under, own, opacity, blend)[k % 4]));
    }
    return most;
  }
  /// Blends kOwn and kOwnGlass over a globe that shows `below` everywhere, within `off` levels.
  void expect_formula(Globe& globe, const Part& below, int off, const TileGrid& grid = kBlendGrid) {
    const Picture bare = shot(globe);
    EXPECT_LE(farthest(bare, below), off);
    for (const LayerBlend blend : kBlends) {
      for (const auto& [own, opacity] : {std::pair(kOwn, 1.0), {kOwn, 0.5}, {kOwnGlass, 1.0}, {kOwnGlass, 0.5}}) {
        SCOPED_TRACE(testing::Message() << int(blend) << ' ' << int{own[3]} << ' ' << opacity);
        const LayerId layer = add(globe, own, {.opacity = opacity, .blend = blend}, grid);
        EXPECT_LE(farthest_blend(shot(globe), bare, own, opacity, blend), own[3] < 255 ? kGlassLevels : kLevel);
        ASSERT_TRUE(globe.remove(layer));
      }
    }
  }
  /// Blends kOwn with kBelow in light and air, with other layers below that leave kBelow as it is.
  void expect_painted(Globe& globe, const std::vector<Camera>& cameras) {
    add(globe, kBelow);
    for (const LayerBlend blend : kBlends) {
      for (const Camera& camera : cameras) {
        SCOPED_TRACE(testing::Message() << int(blend) << ' ' << camera.eye.lat.deg() << ' ' << camera.eye.lon.deg());
        const LayerId layer = add(globe, kOwn, {.blend = blend});
        const Picture seen = shot(globe, camera);
        ASSERT_TRUE(globe.remove(layer));
        const LayerId painted = add(globe, rounded(after(part_of(kBelow), kOwn, 1.0, blend)));
        const Picture wanted = shot(globe, camera);
        ASSERT_TRUE(globe.remove(painted));
        EXPECT_LE(farthest(seen, wanted), kHazeLevels);
        int hazy = 0;
        for (std::size_t k = 0; k < seen.rgba.size(); ++k)
          hazy += std::abs(int{seen.rgba[k]} - int{wanted.rgba[k]}) > kLitLevels ? 1 : 0;
        EXPECT_LE(hazy, kMostHazy * double(seen.rgba.size()));
        EXPECT_GT(farthest(shot(globe, camera), wanted), 20.0);
      }
    }
  }
};

TEST_F(Blends, EqualTheirFormulas) {
  const auto globe = globe_of(unlit_options());
  add(*globe, kBelow);
  expect_formula(*globe, part_of(kBelow), 0);
}

TEST_F(Blends, OverMoreLayersThanOnePassCombines) {
  for (const bool one_by_one : {false, true}) {
    const auto globe = globe_of(unlit_options());
    Experiments::of(*globe).layers_one_by_one = one_by_one;
    Part below = part_of(kBelow);
    add(*globe, kBelow);
    for (const Rgba& color : {Rgba{10, 250, 90, 255}, Rgba{250, 10, 90, 128}, Rgba{30, 30, 250, 255},
                              Rgba{10, 250, 20, 255}, Rgba{90, 90, 90, 128}}) {
      add(*globe, color, {.opacity = 0.5});
      below = after(below, color, 0.5, LayerBlend::normal);
    }
    expect_formula(*globe, below, 3 * kLevel);  // the passes below have roundings
  }
}

TEST_F(Blends, OfAnotherGrid) {
  const auto globe = globe_of(unlit_options());
  add(*globe, kBelow);
  expect_formula(*globe, part_of(kBelow), 0, kOtherRows);
}

TEST_F(Blends, OverAnotherAndUnderOthers) {
  const auto globe = globe_of(unlit_options());
  Part sum = part_of(kBelow);
  add(*globe, kBelow);
  for (const auto& [color, blend] : {std::pair(kOwn, LayerBlend::screen),
                                     {Rgba{250, 180, 90, 200}, LayerBlend::multiply},
                                     {Rgba{40, 200, 220, 90}, LayerBlend::normal},
                                     {Rgba{90, 20, 180, 255}, LayerBlend::difference}}) {
    add(*globe, color, {.opacity = 0.75, .blend = blend});
    sum = after(sum, color, 0.75, blend);
  }
  EXPECT_LE(farthest(shot(*globe), sum), 2 * kLevel);  // a rounding for each layer
}

TEST_F(Blends, OnATranslucentGlobe) {
  for (const Blend surface : {Blend::normal, Blend::additive}) {
    for (const LayerBlend blend : kBlends) {
      GlobeOptions options = unlit_options();
      options.surface.alpha = 0.5;
      options.surface.blend = surface;
      const auto blended = globe_of(options), painted = globe_of(options);
      for (Globe* globe : {blended.get(), painted.get()}) add(*globe, kBelow);
      add(*blended, kOwn, {.opacity = 0.5, .blend = blend});
      add(*painted, rounded(after(part_of(kBelow), kOwn, 0.5, blend)));
      for (const Camera& camera : {camera_at(5, 20, 1.0e7), camera_at(5, 20, -1.0e5)}) {
        EXPECT_LE(farthest(shot(*blended, camera), shot(*painted, camera)), kLitLevels) << int(blend);
      }
    }
  }
}

TEST_F(Blends, InTheLightOfTheSunAndAir) {
  GlobeOptions options;
  options.sky = true;
  options.time = *parse_utc("2026-03-20T18:30Z");  // the terminator lies across Europe
  const auto globe = globe_of(options);
  expect_painted(*globe, {camera_at(5, 20, 1.0e7), camera_at(40, 10, 4.0e5, 30, -20), camera_at(0, -60, 2.0e6),
                          camera_at(89, 0, 3.0e6)});
}

TEST_F(Blends, OnRelief) {
  const auto heights = ElevationSource::open(
      painted_heights({.tile_px = 64, .max_level = 2},
                      [](double lat, double lon) { return 3000.0 * std::sin(20.0 * lat) * std::cos(20.0 * lon); }),
      "heights");
  ASSERT_TRUE(heights);
  const auto globe = globe_of({});
  ASSERT_TRUE(globe->set_elevation(*heights));
  expect_painted(*globe, {camera_at(5, 20, 1.0e7), camera_at(40, 10, 4.0e5, 30, -45)});
}

TEST_F(Blends, InPicturesOfTwoEyes) {
  for (const Stereo stereo : {Stereo::side_by_side, Stereo::interlaced, Stereo::anaglyph}) {
    const auto globe = globe_of({});
    globe->set_stereo({.mode = stereo});
    expect_painted(*globe, {camera_at(5, 20, 1.0e7)});
  }
}

TEST_F(Blends, OnOneSideOfASwipe) {
  GlobeOptions options = unlit_options();
  options.surface.swipe = 0.5;
  const auto globe = globe_of(options);
  add(*globe, kBelow);
  add(*globe, kOwn, {.swipe = SwipeSide::before, .blend = LayerBlend::multiply});
  const Picture seen = shot(*globe);
  const Rgba product = rounded(after(part_of(kBelow), kOwn, 1.0, LayerBlend::multiply));
  EXPECT_NEAR(seen.at(10, 30)[0], product[0], kLevel);
  EXPECT_NEAR(seen.at(10, 30)[2], product[2], kLevel);
  EXPECT_EQ(seen.at(50, 30), (Color{kBelow[0], kBelow[1], kBelow[2]}));
}

// The lowest layer has nothing below, also if it is clear in part and lies on the plain colour.
TEST_F(Blends, TheLowestLayerIsNormal) {
  for (const Rgba& color : {kOwn, kOwnGlass}) {
    const auto blended = globe_of(unlit_options()), plain = globe_of(unlit_options());
    add(*blended, color, {.blend = LayerBlend::multiply});
    add(*plain, color);
    EXPECT_EQ(shot(*blended).rgba, shot(*plain).rgba);
  }
}

// Unlit numbers keep the picture's light below them, and give none to the layer directly above.
TEST_F(Blends, NumbersBlendAsTheyAreSeen) {
  GlobeOptions options;
  options.sky = true;
  options.time = *parse_utc("2026-03-20T18:30Z");
  const NumberLook look{.low = 0.0, .high = 4.0, .colors = {.stops = {{0.0, {120, 60, 220}}, {1.0, {120, 60, 220}}}}};
  const auto twos = [] { return std::make_shared<PaintedNumbers>(kBlendGrid, [](double, double) { return 2.0F; }); };
  for (const LayerBlend blend : kBlends) {
    const auto above = globe_of(options), below = globe_of(options);
    add(*above, kBelow);
    const Picture bare = shot(*above);
    ASSERT_TRUE(above->add_imagery(twos(), {.blend = blend, .numbers = look}));
    const Picture seen = shot(*above);
    for (std::size_t k = 0; k < seen.rgba.size(); ++k) {
      if (k % 4 == 3) continue;
      const double wanted = 255.0 * blended(bare.rgba[k] / 255.0, kOwn[k % 4] / 255.0, blend);
      ASSERT_NEAR(seen.rgba[k], wanted, kLevel) << k;
    }
    ASSERT_TRUE(below->add_imagery(twos(), {.numbers = look}));
    add(*below, kBelow, {.blend = blend});
    EXPECT_LE(farthest(shot(*below), after(part_of(kOwn), kBelow, 1.0, blend)), kLevel);
  }
}

// White ink multiplied, black ink on a screen and black differences change nothing, lamps of the night included.
TEST_F(Blends, NeutralColoursChangeNothing) {
  GlobeOptions options;
  options.sky = true;
  options.time = *parse_utc("2026-03-20T18:30Z");
  const auto globe = globe_of(options);
  add(*globe, kBelow);
  add(*globe, {250, 250, 200, 255}, {.opacity = 0.7, .daylight = Daylight::night});
  for (const Camera& camera : {camera_at(5, 20, 1.0e7), camera_at(40, 60, 4.0e5, 30, -45)}) {
    const Picture bare = shot(*globe, camera);
    for (const LayerBlend blend : kBlends) {
      const std::uint8_t ink = blend == LayerBlend::multiply ? 255 : 0;
      const LayerId layer = add(*globe, {ink, ink, ink, 255}, {.blend = blend});
      EXPECT_LE(farthest(shot(*globe, camera), bare), kLevel) << int(blend);
      ASSERT_TRUE(globe->remove(layer));
    }
  }
}

TEST_F(Blends, ALayerWithAHeightIsRefused) {
  const auto globe = globe_of(unlit_options());
  const auto added =
      globe->add_imagery(one_colour(kBlendGrid, {1, 2, 3}), {.height_m = 8000.0, .blend = LayerBlend::screen});
  ASSERT_FALSE(added);
  EXPECT_NE(added.error().message.find("blend"), std::string::npos) << added.error().message;
}

}  // namespace
}  // namespace terrella::test
