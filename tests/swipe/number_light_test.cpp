// The light of layers of numbers: without it each pixel has the colour of the legend.
#include <gtest/gtest.h>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/layer_source.h"
#include "tests/gl/painted_heights.h"
#include "tests/gl/painted_numbers.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kSeen{160, 120};
const TileGrid kNumberGrid{.tile_px = 64, .max_level = 4};

/// Straight down, a pole, ±180° with the limb, a tilted view.
std::vector<Camera> light_cameras() {
  return {camera_at(5, 20, 1.0e7), camera_at(90, 0, 3.0e6), camera_at(10, 180, 2.0e7),
          camera_at(40, 10, 4.0e5, 30, -20)};
}

/// A globe of numbers in the colours that a map gives them.
class NumberLight : public GlTest {
 protected:
  static constexpr Color kTwo{40, 200, 90};
  /// Adds the number 2 everywhere, in the colour kTwo.
  static LayerId add_twos(Globe& globe, bool lit) {
    NumberLook colors{.low = 0.0,
                      .high = 4.0,
                      .colors = {.stops = {{0.0, {200, 0, 0}}, {1.9, {40, 200, 90}}, {2.1, {40, 200, 90}}},
                                 .by_value = true,
                                 .discrete = true},
                      .lit = lit};
    const auto layer = globe.add_imagery(
        std::make_shared<PaintedNumbers>(kNumberGrid, [](double, double) { return 2.0F; }), {.numbers = colors});
    EXPECT_TRUE(layer);
    return layer ? *layer : LayerId::none;
  }
  /// Pixels inside the globe's disc, three pixels off its limb, that do not have the colour.
  int others(Globe& globe, const Camera& camera, const Color& color) {
    globe.set_camera(camera);
    settle(globe, kSeen);
    const Picture seen = picture();
    const View view = globe.view(kSeen);
    int count = 0;
    for (int y = 3; y < kSeen.height_px - 3; ++y) {
      for (int x = 3; x < kSeen.width_px - 3; ++x) {
        bool inside = true;
        for (const glm::dvec2& side : {glm::dvec2{3, 0}, {-3, 0}, {0, 3}, {0, -3}}) {
          inside = inside && pick(view, globe.ground(), glm::dvec2(x + 0.5, y + 0.5) + side);
        }
        count += inside && seen.at(x, y) != color ? 1 : 0;
      }
    }
    return count;
  }
  static std::unique_ptr<Globe> night_globe() {
    GlobeOptions options;
    options.sky = true;
    options.time = *parse_utc("2026-03-20T18:30Z");  // the terminator lies across Europe
    options.night_lights = {64, 32, std::vector<std::uint8_t>(64 * 32, 200)};
    auto globe = Globe::create(options);
    EXPECT_TRUE(globe);
    return globe ? std::move(*globe) : nullptr;
  }
};

TEST_F(NumberLight, HasTheColoursOfTheLegendByNightAndAtTheLimb) {
  const auto globe = night_globe();
  const LayerId layer = add_twos(*globe, false);
  for (const Camera& camera : light_cameras()) EXPECT_EQ(others(*globe, camera, kTwo), 0);
  ImageLook look = *globe->look(layer);
  look.numbers->lit = true;
  ASSERT_TRUE(globe->set_look(layer, look));
  for (const Camera& camera : light_cameras()) EXPECT_GT(others(*globe, camera, kTwo), 1000);
}

TEST_F(NumberLight, HasThemOverPicturesAndUnderThem) {
  for (const bool one_more : {false, true}) {
    const auto globe = night_globe();
    ASSERT_TRUE(globe->add_imagery(one_colour(kNumberGrid, {120, 60, 30})));
    add_twos(*globe, false);
    // A clear layer whose brightness is its alpha needs other programs.
    if (one_more) {
      ASSERT_TRUE(globe->add_imagery(std::make_shared<LayerSource>(kNumberGrid,
                                                                   [](double, double) {
                                                                     return Rgba{0, 0, 0, 255};
                                                                   }),
                                     {.alpha = AlphaFrom::brightness}));
    }
    for (const Camera& camera : light_cameras()) EXPECT_EQ(others(*globe, camera, kTwo), 0) << one_more;
  }
}

TEST_F(NumberLight, HasThemOnRelief) {
  const auto heights = ElevationSource::open(
      painted_heights({.tile_px = 64, .max_level = 2},
                      [](double lat, double lon) { return 3000.0 * std::sin(20.0 * lat) * std::cos(20.0 * lon); }),
      "heights");
  ASSERT_TRUE(heights);
  const auto globe = night_globe();
  add_twos(*globe, false);
  ASSERT_TRUE(globe->set_elevation(*heights));
  EXPECT_EQ(others(*globe, camera_at(5, 20, 1.0e7), kTwo), 0);
  EXPECT_EQ(others(*globe, camera_at(40, 10, 4.0e5, 30, -45), kTwo), 0);
}

}  // namespace
}  // namespace terrella::test
