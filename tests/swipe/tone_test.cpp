// The tone of a layer: brightness, contrast and gamma. Judged by tiles that were painted with the changed colours.
#include <gtest/gtest.h>

#include <cmath>

#include "globe/experiments.h"
#include "tests/gl/gl_fixture.h"
#include "tests/gl/layer_source.h"
#include "tests/gl/painted_numbers.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kToned{96, 96};
const TileGrid kToneGrid{.tile_px = 64, .max_level = 3};
constexpr Rgba kColor{20, 110, 200, 255}, kGlass{200, 30, 90, 128}, kUnder{90, 90, 30, 255};
// A rounding of the painted colour, and one of each blend.
constexpr int kRoundings = 2;
const ImageTone kTones[] = {{.brightness = 0.3},
                            {.brightness = -0.2, .contrast = 1.8},
                            {.contrast = 0.0},
                            {.gamma = 2.2},
                            {.brightness = 0.1, .contrast = 0.6, .gamma = 0.5}};

Rgba toned(Rgba color, const ImageTone& tone) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double value = (color[k] / 255.0 - 0.5) * tone.contrast + 0.5 + tone.brightness;
    const double shown = std::pow(std::clamp(value, 0.0, 1.0), 1.0 / tone.gamma);
    color[k] = static_cast<std::uint8_t>(std::lround(255.0 * shown));
  }
  return color;
}

class LayerTone : public GlTest {
 protected:
  static void add(Globe& globe, const Rgba& color, const ImageLook& look = {}) {
    ASSERT_TRUE(
        globe.add_imagery(std::make_shared<LayerSource>(kToneGrid, [color](double, double) { return color; }), look));
  }
  static std::unique_ptr<Globe> globe_of(const GlobeOptions& options) {
    auto globe = Globe::create(options);
    EXPECT_TRUE(globe);
    return globe ? std::move(*globe) : nullptr;
  }
  Picture shot(Globe& globe) {
    globe.set_camera(camera_at(5, 20, 1.0e7));
    settle(globe, kToned);
    return picture();
  }
  static int farthest(const Picture& a, const Picture& b) {
    int most = 0;
    for (std::size_t k = 0; k < a.rgba.size(); ++k) most = std::max(most, std::abs(int{a.rgba[k]} - int{b.rgba[k]}));
    return most;
  }
  void expect_painted(const GlobeOptions& options, bool one_by_one) {
    for (const ImageTone& tone : kTones) {
      SCOPED_TRACE(testing::Message() << tone.brightness << ' ' << tone.contrast << ' ' << tone.gamma);
      const auto by_tone = globe_of(options), painted = globe_of(options), plain = globe_of(options);
      for (Globe* globe : {by_tone.get(), painted.get(), plain.get()}) {
        Experiments::of(*globe).layers_one_by_one = one_by_one;
        add(*globe, kUnder);
      }
      for (const Rgba& color : {kColor, kGlass}) {
        add(*by_tone, color, {.opacity = 0.75, .tone = tone});
        add(*painted, toned(color, tone), {.opacity = 0.75});
        add(*plain, color, {.opacity = 0.75});
      }
      const Picture wanted = shot(*painted);
      EXPECT_LE(farthest(shot(*by_tone), wanted), kRoundings);
      EXPECT_GT(farthest(shot(*plain), wanted), 5 * kRoundings);
    }
  }
};

TEST_F(LayerTone, LooksLikeTilesPaintedSo) { expect_painted(unlit_options(), false); }

TEST_F(LayerTone, InAPassOfEachLayer) { expect_painted(unlit_options(), true); }

TEST_F(LayerTone, OnATranslucentGlobe) {
  GlobeOptions options = unlit_options();
  options.surface.alpha = 0.5;
  expect_painted(options, false);
}

TEST_F(LayerTone, InTheLightOfTheSun) {
  GlobeOptions options;
  options.sky = true;
  options.time = *parse_utc("2026-03-20T12:30Z");
  expect_painted(options, false);
}

TEST_F(LayerTone, OfTheLowestLayer) {
  for (const ImageTone& tone : kTones) {
    const auto by_tone = globe_of(unlit_options()), painted = globe_of(unlit_options());
    add(*by_tone, kColor, {.tone = tone});
    add(*painted, toned(kColor, tone));
    EXPECT_LE(farthest(shot(*by_tone), shot(*painted)), kRoundings);
  }
}

TEST_F(LayerTone, IsRefusedOutOfItsRangeAndForNumbers) {
  const auto globe = globe_of(unlit_options());
  const auto refusal = [&](const ImageLook& look, std::shared_ptr<TileSource> source) {
    const auto added = globe->add_imagery(std::move(source), look);
    return added ? std::string() : added.error().message;
  };
  const auto picture = [] { return one_colour(kToneGrid, {1, 2, 3}); };
  EXPECT_NE(refusal({.tone = {.brightness = 1.5}}, picture()).find("brightness"), std::string::npos);
  EXPECT_NE(refusal({.tone = {.contrast = -1.0}}, picture()).find("contrast"), std::string::npos);
  EXPECT_NE(refusal({.tone = {.gamma = 0.0}}, picture()).find("gamma"), std::string::npos);
  const auto numbers = std::make_shared<PaintedNumbers>(kToneGrid, [](double, double) { return 1.0F; });
  EXPECT_NE(refusal({.tone = {.gamma = 2.0}, .numbers = NumberLook{}}, numbers).find("tone"), std::string::npos);
}

}  // namespace
}  // namespace terrella::test
