// The value at a place: from the texture slots as it is drawn, and from the source as it is stored.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/geo/geo_test_support.h"
#include "tests/gl/gl_fixture.h"
#include "tests/gl/painted_numbers.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kValueShot{96, 96};
constexpr int kTile_px = 64, kFinest = 4;
constexpr double kTexel_deg = 180.0 / kTile_px / (1 << kFinest);
const TileGrid kGrid{.tile_px = kTile_px, .max_level = kFinest};

/// A number for each texel of the finest level, with as many digits as a float holds; none for one in sixteen.
double finest_number(double lon, double row) {
  const auto x = static_cast<std::uint32_t>(std::floor((lon + 180.0) / kTexel_deg));
  const auto y = static_cast<std::uint32_t>(std::floor((90.0 - row) / kTexel_deg));
  const std::uint32_t mixed = (x * 2654435761U) ^ (y * 2246822519U);
  if (mixed % 16 == 3) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(static_cast<float>(mixed) * 1e-3F);
}
float painted(double lon, double row) { return static_cast<float>(finest_number(lon, row)); }

/// The texel around a place of the finest level, by its middle.
double number_around(const Geodetic& place) {
  const double x = std::floor((place.lon.deg() + 180.0) / kTexel_deg),
               y = std::floor((90.0 - place.lat.deg()) / kTexel_deg);
  return finest_number(-180.0 + (x + 0.5) * kTexel_deg, 90.0 - (y + 0.5) * kTexel_deg);
}

Geodetic at(double lat, double lon) { return {.lat = Angle::degrees(lat), .lon = Angle::degrees(lon)}; }

class NumberValues : public GlTest {
 protected:
  LayerId add(const std::shared_ptr<TileSource>& source) {
    auto globe = Globe::create(unlit_options());
    EXPECT_TRUE(globe);
    globe_ = std::move(*globe);
    const auto layer = globe_->add_imagery(source, {.numbers = NumberLook{.low = 0.0, .high = 4e6}});
    EXPECT_TRUE(layer);
    return *layer;
  }
  void TearDown() override {
    globe_.reset();
    GlTest::TearDown();
  }
  std::unique_ptr<Globe> globe_;
};

TEST_F(NumberValues, OfLoadedTilesAreThoseOfTheSourceBitByBit) {
  const LayerId layer = add(
      std::make_shared<PaintedNumbers>(kGrid, painted, NumberInfo{.scale = 0.1, .offset = -273.15, .floats = true}));
  globe_->set_camera(camera_at(10, 178, 5.0e5));
  settle(*globe_, kValueShot);
  Draw draw(7);
  int finest = 0, none = 0;
  for (int k = 0; k < 300; ++k) {
    double lon = draw.between(176.5, 180.5);
    if (lon > 180.0) lon -= 360.0;
    const Geodetic place = at(draw.between(9.0, 11.0), lon);
    const auto value = globe_->value_at(layer, place);
    ASSERT_TRUE(value && *value);
    if ((*value)->level != kFinest) continue;
    ++finest;
    const double number = number_around(place);
    if (std::isnan(number)) {
      ++none;
      EXPECT_TRUE(std::isnan((*value)->value));
    } else {
      EXPECT_EQ((*value)->value, number * 0.1 - 273.15);
    }
  }
  EXPECT_GT(finest, 250);
  EXPECT_GT(none, 3);
  // Beside the view coarser tiles are loaded, the roots everywhere.
  const auto far = globe_->value_at(layer, at(-40, 10));
  ASSERT_TRUE(far && *far);
  EXPECT_EQ((*far)->level, 0);
}

TEST_F(NumberValues, OfCodesAreThoseOfTheSource) {
  const auto whole = [](double lon, double row) {
    const double number = finest_number(lon, row);
    return std::isnan(number) ? std::numeric_limits<float>::quiet_NaN()
                              : static_cast<float>(std::fmod(std::floor(number), 60000.0) - 30000.0);
  };
  const LayerId layer = add(
      std::make_shared<PaintedNumbers>(kGrid, whole, NumberInfo{.floats = true, .whole = WholeRange{-32767, 32767}}));
  globe_->set_camera(camera_at(10, 20, 5.0e5));
  settle(*globe_, kValueShot);
  Draw draw(8);
  for (int k = 0; k < 200; ++k) {
    const Geodetic place = at(draw.between(9.0, 11.0), draw.between(19.0, 21.0));
    const auto value = globe_->value_at(layer, place);
    ASSERT_TRUE(value && *value && (*value)->level == kFinest);
    const double number = number_around(place);
    EXPECT_EQ(std::isnan(number), std::isnan((*value)->value));
    if (std::isnan(number)) continue;
    EXPECT_EQ((*value)->value, std::fmod(std::floor(number), 60000.0) - 30000.0);
  }
}

/// In a squeezed row a texel is several times as wide. The number grows by one a degree of longitude.
TEST_F(NumberValues, NearAPoleAreThoseOfTheSqueezedTexel) {
  TileGrid grid = kGrid;
  grid.reduced = true;
  const LayerId layer =
      add(std::make_shared<PaintedNumbers>(grid, [](double lon, double) { return static_cast<float>(lon); }));
  globe_->set_camera(camera_at(89, 20, 1.0e6));
  settle(*globe_, kValueShot);
  Draw draw(9);
  double widest = 0.0;
  for (int k = 0; k < 100; ++k) {
    const Geodetic place = at(draw.between(86.0, 90.0), draw.between(-180.0, 180.0));
    const auto value = globe_->value_at(layer, place);
    ASSERT_TRUE(value && *value);
    widest = std::max(widest, std::abs((*value)->value - place.lon.deg()));
  }
  EXPECT_LE(widest, 0.5 * 16.0 * kTexel_deg * 16.0);
  EXPECT_GT(widest, 0.5 * kTexel_deg);
}

TEST_F(NumberValues, OfTheSourceNeedNoTile) {
  const LayerId layer = add(
      std::make_shared<PaintedNumbers>(kGrid, painted, NumberInfo{.scale = 0.1, .offset = -273.15, .floats = true}));
  Draw draw(10);
  int none = 0;
  for (int k = 0; k < 50; ++k) {
    const Geodetic place = at(draw.between(-90.0, 90.0), draw.between(-180.0, 180.0));
    const auto value = globe_->stored_value(layer, place).get();
    const double number = number_around(place);
    if (std::isnan(number)) {
      ++none;
      ASSERT_FALSE(value);
      EXPECT_EQ(value.error().kind, MissingKind::blank);
    } else {
      ASSERT_TRUE(value) << value.error().why;
      EXPECT_EQ(*value, number * 0.1 - 273.15);
    }
  }
  EXPECT_GT(none, 0);
}

TEST_F(NumberValues, OfPicturesAreRefused) {
  const LayerId layer = add(std::make_shared<PaintedNumbers>(kGrid, painted));
  EXPECT_FALSE(globe_->value_at(static_cast<LayerId>(77), at(0, 0)));
  const auto picture = globe_->add_imagery(one_colour(kGrid, {1, 2, 3}));
  ASSERT_TRUE(picture);
  EXPECT_FALSE(globe_->value_at(*picture, at(0, 0)));
  EXPECT_FALSE(globe_->stored_value(*picture, at(0, 0)).get());
  const auto nothing = globe_->value_at(layer, at(0, 0));
  ASSERT_TRUE(nothing);
  EXPECT_FALSE(*nothing) << "no tile is loaded before the first frame";
}

}  // namespace
}  // namespace terrella::test
