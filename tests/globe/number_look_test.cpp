// Stretches and colour maps without OpenGL, and the texels that tiles of numbers become.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "tiles/number_texels.h"
#include "view/number_look.h"

namespace terrella::test {
namespace {

constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();

NumberLook look_with(const char* map, double low, double high) {
  return {.low = low, .high = high, .colors = *named_color_map(map)};
}

/// Ends and middles from the publications of the maps, to the rounding of a byte.
TEST(ColorMaps, OfTheEngineHaveTheirPublishedColors) {
  EXPECT_EQ(color_at(*named_color_map("viridis"), 0.0), (Rgba8{68, 1, 84}));
  EXPECT_EQ(color_at(*named_color_map("viridis"), 1.0), (Rgba8{253, 231, 37}));
  EXPECT_EQ(color_at(*named_color_map("magma"), 1.0), (Rgba8{252, 253, 191}));
  EXPECT_EQ(color_at(*named_color_map("cividis"), 0.0), (Rgba8{0, 34, 78}));
  EXPECT_EQ(color_at(*named_color_map("grey"), 0.5), (Rgba8{128, 128, 128}));
  EXPECT_EQ(color_at(*named_color_map("diverging"), 0.5), (Rgba8{221, 221, 221}));
  EXPECT_EQ(color_at(*named_color_map("diverging"), 1.0), (Rgba8{180, 4, 38}));
  EXPECT_FALSE(named_color_map("jet"));
  for (const std::string_view name : color_map_names()) {
    const NumberLook look{.low = 0.0, .high = 1.0, .colors = *named_color_map(name)};
    EXPECT_TRUE(check_look(look)) << name;
  }
}

TEST(ColorMaps, InterpolateOrHoldAndClampAtTheirEnds) {
  ColorMap map{.stops = {{1.0, {0, 0, 0, 0}}, {3.0, {100, 200, 50, 255}}}, .by_value = true};
  EXPECT_EQ(color_at(map, 0.0), (Rgba8{0, 0, 0, 0}));
  EXPECT_EQ(color_at(map, 2.0), (Rgba8{50, 100, 25, 128}));
  EXPECT_EQ(color_at(map, 9.0), (Rgba8{100, 200, 50, 255}));
  map.discrete = true;
  EXPECT_EQ(color_at(map, 2.999), (Rgba8{0, 0, 0, 0}));
  EXPECT_EQ(color_at(map, 3.0), (Rgba8{100, 200, 50, 255}));
}

TEST(NumberLooks, StretchBothHalvesAboutACentre) {
  NumberLook look = look_with("diverging", -1.0, 4.0);
  look.center = 0.0;
  const ColorMap& map = look.colors;
  EXPECT_EQ(color_of(look, -1.0), color_at(map, 0.0));
  EXPECT_EQ(color_of(look, -0.5), color_at(map, 0.25));
  EXPECT_EQ(color_of(look, 0.0), color_at(map, 0.5));
  EXPECT_EQ(color_of(look, 2.0), color_at(map, 0.75));
  EXPECT_EQ(color_of(look, 99.0), color_at(map, 1.0));
  look.center = -5.0;  // below the stretch: only the upper half
  EXPECT_EQ(color_of(look, -1.0), color_at(map, 0.5));
  EXPECT_EQ(color_of(look, 4.0), color_at(map, 1.0));
}

TEST(NumberLooks, AreBakedPremultiplied) {
  const NumberLook look{.low = -2.0, .high = 2.0, .colors = {.stops = {{0.0, {200, 100, 0, 128}}}}};
  const auto texels = bake(look);
  ASSERT_EQ(texels.size(), 4U * kBakedColors);
  EXPECT_EQ(texels[0], 100);
  EXPECT_EQ(texels[1], 50);
  EXPECT_EQ(texels[3], 128);
  const auto grey = bake(NumberLook{.low = 5.0, .high = 6.0});
  EXPECT_EQ(grey.front(), 0);
  EXPECT_EQ(grey[4 * 512], std::lround(255.0 * 512.5 / 1024.0));
}

TEST(NumberLooks, ThatCannotBeDrawnAreRefused) {
  EXPECT_FALSE(check_look({.low = 2.0, .high = 1.0}));
  EXPECT_FALSE(check_look({.low = kNowhere, .high = 1.0}));
  EXPECT_FALSE(check_look({.center = kNowhere}));
  EXPECT_FALSE(check_look({.contour_step = kNowhere}));
  EXPECT_FALSE(check_look({.contour_step = -1.0}));
  EXPECT_FALSE(check_look({.colors = {}}));
  EXPECT_FALSE(check_look({.colors = {.stops = {{1.0, {}}, {0.0, {}}}}}));
}

TEST(NumberSlots, AreCodesWhereACodeIsFreeForNoData) {
  EXPECT_EQ(number_slots({.whole = WholeRange{0, 255}}), (NumberSlots{true, 0.0, 257.0 - 1.0, 65535}));
  EXPECT_EQ(number_slots({.whole = WholeRange{-32767, 32767}}), (NumberSlots{true, -32767.0, 1.0, 65535}));
  EXPECT_EQ(number_slots({.nodata = -9999.0, .whole = WholeRange{-32768, 32767}}),
            (NumberSlots{true, -32768.0, 1.0, 22769}));
  for (const NumberInfo& info :
       {NumberInfo{}, NumberInfo{.whole = WholeRange{0, 65535}},
        NumberInfo{.nodata = -1.0, .whole = WholeRange{0, 65535}}, NumberInfo{.whole = WholeRange{0, 70000}}}) {
    EXPECT_FALSE(number_slots(info).codes);
  }
}

/// A tile of 16 × 16 numbers, 0 in the left half but for one texel, and 100 in the right.
EncodedTile half_and_half() {
  EncodedTile tile;
  tile.make_numbers = []() -> Result<Numbers, TileFailure> {
    Numbers numbers{16, 16, std::vector<float>(256, 100.0F)};
    for (std::size_t k = 0; k < 256; ++k) {
      if (k % 16 < 8) numbers.values[k] = std::numeric_limits<float>::quiet_NaN();
    }
    numbers.values[0] = 10.0F;
    numbers.values[1] = 20.0F;
    numbers.values[8 * 16] = 30.0F;  // alone among four
    return numbers;
  };
  return tile;
}

template <class T>
double texel(const TileTexels& texels, std::size_t mip, int x, int y, const NumberSlots& slots) {
  const int side = mip_side_px(16, 4, static_cast<int>(mip)), border = 4 >> mip;
  T value{};
  std::memcpy(&value, texels.mips[mip].data() + sizeof(T) * static_cast<std::size_t>((y + border) * side + x + border),
              sizeof(T));
  return number_of(slots, static_cast<double>(value));
}

TEST(NumberTexels, AreMeansOfWhatHasData) {
  for (const NumberInfo& info : {NumberInfo{.floats = true}, NumberInfo{.floats = true, .whole = WholeRange{0, 255}}}) {
    const NumberSlots slots = number_slots(info);
    const auto made = make_number_texels(half_and_half(), info, 16, 4, 3);
    ASSERT_TRUE(made) << made.error().why;
    EXPECT_FALSE(made->opaque);
    EXPECT_EQ(made->mips[1].size(), texel_bytes(slots) * 12 * 12);
    const auto at = [&](std::size_t mip, int x, int y) {
      return slots.codes ? texel<std::uint16_t>(*made, mip, x, y, slots) : texel<float>(*made, mip, x, y, slots);
    };
    EXPECT_EQ(at(0, 0, 0), 10.0);
    EXPECT_EQ(at(0, -4, -4), 10.0) << "the gutter repeats the edge";
    EXPECT_TRUE(std::isnan(at(0, 2, 2)));
    EXPECT_EQ(at(1, 0, 0), 15.0) << "half of the texels have data";
    EXPECT_TRUE(std::isnan(at(1, 0, 4))) << "a quarter has data";
    EXPECT_EQ(at(1, 4, 3), 100.0);
    EXPECT_EQ(at(2, 3, 3), 100.0);
  }
}

TEST(NumberTexels, OfAnotherSizeAreBroken) {
  const auto made = make_number_texels(half_and_half(), {.floats = true}, 32, 4, 1);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().kind, MissingKind::broken);
}

}  // namespace
}  // namespace terrella::test
