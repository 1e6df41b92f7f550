// Layers of numbers: filtered as numbers, never mixed with "no data", coloured after that.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/gl/gl_fixture.h"
#include "tests/gl/layer_source.h"
#include "tests/gl/painted_numbers.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kIslands{96, 96};
constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();
constexpr Color kPlainColor{30, 38, 52};

// Slots of 32-bit floats, and of 16-bit codes with "no data" beside and among the numbers.
const NumberInfo kFloats{.floats = true};
const NumberInfo kShort{.floats = true, .whole = WholeRange{0, 255}};
const NumberInfo kLong{.nodata = 4096.0, .floats = true, .whole = WholeRange{0, 65535}};

TileGrid grid_of(bool reduced = false) { return {.tile_px = 64, .max_level = 5, .reduced = reduced}; }

/// Two poles, the antimeridian, the equator from afar and near, a slant.
std::vector<Camera> number_cameras() {
  return {camera_at(5, 20, 1.0e7),          camera_at(90, 0, 4.0e6),      camera_at(-90, 0, 4.0e6),
          camera_at(6, 180, 1.5e6, 30),     camera_at(36, -179.9, 1.0e5), camera_at(84, 60, 1.0e6),
          camera_at(10, 14, 2.0e6, 30, -60)};
}

/// Islands of 30 and 200, so far apart that no pixel sees both; none at the poles, one across the antimeridian.
float islands(double lon, double row) {
  const double band = std::floor((row + 90.0) / 30.0), in_band = row + 75.0 - 30.0 * band;
  if (std::abs(in_band) > 9.0 || std::abs(std::fmod(lon + 360.0, 60.0) - 30.0) < 8.0) return kNoData;
  return std::fmod(band, 2.0) == 0.0 ? 30.0F : 200.0F;
}

/// Red for 30, blue for 200 and green for every mixture of them with each other or with anything else.
NumberLook islands_look() {
  return {.low = 0.0,
          .high = 255.0,
          .colors = {.stops = {{0.0, {0, 255, 0}},
                               {29.5, {255, 0, 0}},
                               {30.5, {0, 255, 0}},
                               {199.0, {0, 0, 255}},
                               {201.0, {0, 255, 0}}},
                     .by_value = true,
                     .discrete = true}};
}

struct Counts {
  int low = 0, high = 0, mixed = 0;
};

class NumberLayers : public GlTest {
 protected:
  static std::unique_ptr<Globe> empty_globe(const GlobeOptions& options = unlit_options()) {
    auto globe = Globe::create(options);
    EXPECT_TRUE(globe);
    return globe ? std::move(*globe) : nullptr;
  }
  static LayerId add(Globe& globe, std::shared_ptr<TileSource> source, const ImageLook& look) {
    const auto layer = globe.add_imagery(std::move(source), look);
    EXPECT_TRUE(layer) << (layer ? "" : layer.error().message);
    return layer ? *layer : LayerId::none;
  }
  static LayerId add_islands(Globe& globe, const NumberInfo& meaning, ImageLook look = {}, bool reduced = false) {
    look.numbers = islands_look();
    return add(globe, std::make_shared<PaintedNumbers>(grid_of(reduced), islands, meaning), look);
  }
  Picture settled(Globe& globe, const Camera& camera) {
    globe.set_camera(camera);
    settle(globe, kIslands);
    return picture();
  }
  /// Pixels by colour; `nothing` is what shows where there are no data. Where the antialiased limb blends with black
  /// space, no channel grows, so green is a mixture of numbers.
  static Counts count(const Picture& shot, const Color& nothing, double opacity) {
    Counts counts;
    const auto share = [&](double channel, double under) { return std::lerp(under, channel, opacity); };
    for (int y = 0; y < kIslands.height_px; ++y) {
      for (int x = 0; x < kIslands.width_px; ++x) {
        const Color color = shot.at(x, y);
        counts.low += std::abs(color[0] - share(255, nothing[0])) < 2.0 && color[2] <= nothing[2] ? 1 : 0;
        counts.high += std::abs(color[2] - share(255, nothing[2])) < 2.0 && color[0] <= nothing[0] ? 1 : 0;
        counts.mixed += color[1] > nothing[1] + 4 ? 1 : 0;
      }
    }
    return counts;
  }
  void expect_unmixed(Globe& globe, const Color& nothing, double opacity = 1.0) {
    for (const Camera& camera : number_cameras()) {
      SCOPED_TRACE(testing::Message() << camera.eye.lat.deg() << ',' << camera.eye.lon.deg() << ','
                                      << camera.eye.height_m);
      const Counts counts = count(settled(globe, camera), nothing, opacity);
      EXPECT_EQ(counts.mixed, 0);
      EXPECT_GT(counts.low + counts.high, 500);
    }
  }
};

TEST_F(NumberLayers, MixNoDataIntoNothingInEveryProgramAndSlot) {
  for (const NumberInfo& meaning : {kFloats, kShort, kLong}) {
    for (const Texturing texturing : {Texturing::automatic, Texturing::vertex, Texturing::exact, Texturing::paper}) {
      SCOPED_TRACE(testing::Message() << "texturing " << static_cast<int>(texturing) << ", whole "
                                      << (meaning.whole ? meaning.whole->most : 0));
      GlobeOptions options = unlit_options();
      options.texturing = texturing;
      const auto globe = empty_globe(options);
      add_islands(*globe, meaning);
      expect_unmixed(*globe, kPlainColor);
    }
  }
}

TEST_F(NumberLayers, MixNothingInTheSqueezedRowsOfThePoles) {
  for (const NumberInfo& meaning : {kFloats, kShort}) {
    const auto globe = empty_globe();
    add_islands(*globe, meaning, {}, true);
    expect_unmixed(*globe, kPlainColor);
  }
}

// Means of 350 and 10 degrees are near 0, in taps and in mips, and never the green of the other directions.
TEST_F(NumberLayers, OfDirectionsGoRound) {
  const auto northerly = [](double lon, double row) {
    if (std::isnan(islands(lon, row))) return kNoData;
    return std::fmod(std::floor(lon * 64.0) + std::floor(row * 64.0), 2.0) == 0.0 ? 350.0F : 10.0F;
  };
  const NumberLook look{.low = 0.0,
                        .high = 360.0,
                        .colors = {.stops = {{0.0, {255, 0, 0}}, {25.0, {0, 255, 0}}, {335.0, {255, 0, 0}}},
                                   .by_value = true,
                                   .discrete = true}};
  for (const Texturing texturing : {Texturing::automatic, Texturing::vertex}) {
    GlobeOptions options = unlit_options();
    options.texturing = texturing;
    const auto globe = empty_globe(options);
    const NumberInfo directions{.floats = true, .period = 360.0};
    add(*globe, std::make_shared<PaintedNumbers>(grid_of(), northerly, directions), {.numbers = look});
    expect_unmixed(*globe, kPlainColor);
    add(*globe, std::make_shared<PaintedNumbers>(grid_of(), northerly, directions), {.opacity = 0.5, .numbers = look});
    expect_unmixed(*globe, kPlainColor);  // as a stack
  }
}

TEST_F(NumberLayers, ShowTheLayerUnderThemWhereTheyHaveNoData) {
  constexpr Color kUnder{120, 120, 40};
  for (const double opacity : {1.0, 0.5}) {
    for (const Daylight daylight : {Daylight::both, Daylight::day}) {
      const auto globe = empty_globe();
      add(*globe, one_colour(grid_of(), kUnder), {});
      add_islands(*globe, kFloats, {.opacity = opacity, .daylight = daylight});
      expect_unmixed(*globe, kUnder, opacity);
    }
  }
}

TEST_F(NumberLayers, AreUnmixedOnATranslucentGlobeAndInStereo) {
  GlobeOptions options = unlit_options();
  options.stereo.mode = Stereo::side_by_side;
  const auto pair = empty_globe(options);
  add_islands(*pair, kShort);
  expect_unmixed(*pair, kPlainColor);
  options = unlit_options();
  options.surface.alpha = 0.5;
  const auto glass = empty_globe(options);
  add_islands(*glass, kShort);
  glass->set_camera(camera_at(5, 20, 1.0e6));
  settle(*glass, kIslands);
  const Picture shot = picture();
  for (std::size_t k = 0; k < shot.rgba.size(); k += 4) {
    ASSERT_TRUE(shot.rgba[k + 1] < 25) << "green at pixel " << k / 4;
  }
}

/// The same numbers as a picture of eight bits: filtering, gutters, parents and poles must agree.
TEST_F(NumberLayers, InGreyLookLikeThePictureOfTheSameNumbers) {
  constexpr int kRoundings = 2;  // a picture's texels are filtered in eight bits by some drivers
  const auto number = [](double lon, double row) {
    return static_cast<float>(
        std::lround(128.0 + 100.0 * std::sin(row * 0.3) * std::cos(row * M_PI / 180.0) * std::sin(lon * M_PI / 10.0)));
  };
  const auto grey = [number](double lon, double row) {
    const auto level = static_cast<std::uint8_t>(number(lon, row));
    return Rgba{level, level, level, 255};
  };
  for (const bool reduced : {false, true}) {
    for (const NumberInfo& meaning : {kFloats, kShort}) {
      const auto numbers = empty_globe(), pictures = empty_globe();
      add(*numbers, std::make_shared<PaintedNumbers>(grid_of(reduced), number, meaning),
          {.numbers = NumberLook{.low = 0.0, .high = 255.0}});
      add(*pictures, std::make_shared<LayerSource>(grid_of(reduced), grey), {});
      for (const Camera& camera : number_cameras()) {
        SCOPED_TRACE(testing::Message() << camera.eye.lat.deg() << ',' << camera.eye.lon.deg() << ','
                                        << camera.eye.height_m << (reduced ? " squeezed" : ""));
        const Picture a = settled(*numbers, camera), b = settled(*pictures, camera);
        int worst = 0;
        for (std::size_t k = 0; k < a.rgba.size(); ++k) worst = std::max(worst, std::abs(a.rgba[k] - b.rgba[k]));
        EXPECT_LE(worst, kRoundings);
      }
    }
  }
}

TEST_F(NumberLayers, TakeAnotherStretchInOneFrameWithoutARequestOrAnUpload) {
  const auto globe = empty_globe();
  const auto source = std::make_shared<PaintedNumbers>(grid_of(), islands, kFloats);
  const LayerId layer = add(*globe, source, {.numbers = islands_look()});
  const Picture before = settled(*globe, camera_at(5, 20, 1.0e7));
  const int reads = source->reads();
  ImageLook look = *globe->look(layer);
  look.numbers = NumberLook{.low = 10.0, .high = 220.0, .colors = *named_color_map("viridis")};
  ASSERT_TRUE(globe->set_look(layer, look));
  EXPECT_TRUE(globe->needs_frame());
  const FrameStats stats = draw(*globe, kIslands);
  EXPECT_EQ(stats.uploaded_bytes, 0U);
  EXPECT_EQ(source->reads(), reads);
  EXPECT_TRUE(globe->settled());
  EXPECT_FALSE(globe->needs_frame());
  const LoaderCounts loading = globe->loading();
  EXPECT_EQ(loading.waiting + loading.running + loading.fetching + loading.finished, 0U);
  const Picture after = picture();
  const Rgba8 low = color_of(*look.numbers, 30.0), high = color_of(*look.numbers, 200.0);
  int changed = 0;
  for (int y = 0; y < kIslands.height_px; ++y) {
    for (int x = 0; x < kIslands.width_px; ++x) {
      const Color was = before.at(x, y), is = after.at(x, y);
      if (was == Color{255, 0, 0}) changed += is == Color{low.r, low.g, low.b} ? 1 : -9999;
      if (was == Color{0, 0, 255}) changed += is == Color{high.r, high.g, high.b} ? 1 : -9999;
    }
  }
  EXPECT_GT(changed, 500);
}

TEST_F(NumberLayers, CountInTheBudgetByTheirBytes) {
  const auto bytes = [this](const NumberInfo& meaning) {
    const auto globe = empty_globe();
    add_islands(*globe, meaning);
    settled(*globe, camera_at(5, 20, 1.0e7));
    return draw(*globe, kIslands).gpu_bytes;
  };
  EXPECT_EQ(bytes(kFloats), 2 * bytes(kShort));
  const auto pictures = empty_globe();
  add(*pictures, one_colour(grid_of(), {1, 2, 3}), {});
  settled(*pictures, camera_at(5, 20, 1.0e7));
  EXPECT_EQ(bytes(kFloats), draw(*pictures, kIslands).gpu_bytes);
}

TEST_F(NumberLayers, NeedAStretchThatPicturesMustNotHave) {
  const auto globe = empty_globe();
  const auto numbers = std::make_shared<PaintedNumbers>(grid_of(), islands);
  const auto complaint = [](const auto& result) { return result ? std::string() : result.error().message; };
  EXPECT_NE(complaint(globe->add_imagery(numbers)).find("ImageLook::numbers"), std::string::npos);
  const ImageLook stretched{.numbers = NumberLook{}};
  EXPECT_NE(complaint(globe->add_imagery(one_colour(grid_of(), {}), stretched)).find("pictures"), std::string::npos);
  const LayerId layer = add(*globe, numbers, stretched);
  EXPECT_NE(complaint(globe->set_look(layer, {})).find("ImageLook::numbers"), std::string::npos);
  EXPECT_NE(complaint(globe->set_look(layer, {.numbers = NumberLook{.low = 1.0, .high = 1.0}})).find("stretch"),
            std::string::npos);
  EXPECT_NE(complaint(globe->set_look(layer, {.numbers = NumberLook{.colors = {}}})).find("colour"), std::string::npos);
}

}  // namespace
}  // namespace terrella::test
