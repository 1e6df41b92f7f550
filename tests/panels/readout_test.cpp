#include "apps/viewer/panels/readout.h"

#include <gtest/gtest.h>

#include <cmath>

#include "apps/viewer/input.h"
#include "apps/viewer/tools/screenshot.h"
#include "geo/body.h"

namespace terrella {
namespace {

Camera down(double lat, double lon, double height_m) {
  return {.eye = {.lat = Angle::degrees(lat), .lon = Angle::degrees(lon), .height_m = height_m}};
}

TEST(PlaceText, HasAsManyDecimalsAsAPixelIsWorth) {
  const Geodetic place{.lat = Angle::degrees(-46.021234), .lon = Angle::degrees(7.749876)};
  EXPECT_EQ(place_text(place, 0.5), "46.0° S   7.7° E");
  EXPECT_EQ(place_text(place, 0.0005), "46.0212° S   7.7499° E");
  EXPECT_EQ(place_text(place, 10.0), "46° S   8° E");
  EXPECT_EQ(place_text(place, 1e-12), "46.0212340° S   7.7498760° E");
  EXPECT_EQ(place_text(place, 0.0), "46° S   8° E");
}

TEST(LengthText, HasThreeDigitsAndGroups) {
  EXPECT_EQ(length_text(1.0), "1 m");
  EXPECT_EQ(length_text(1.234), "1.23 m");
  EXPECT_EQ(length_text(999.0), "999 m");
  EXPECT_EQ(length_text(12345.0), "12.3 km");
  EXPECT_EQ(length_text(384.4e6), "384,400 km");
  EXPECT_EQ(length_text(-250.0), "-250 m");
}

TEST(AreaText, HasThreeDigitsAndGroups) {
  EXPECT_EQ(area_text(12.34), "12.3 m²");
  EXPECT_EQ(area_text(9.0e4), "90,000 m²");
  EXPECT_EQ(area_text(3.4e6), "3.4 km²");
  EXPECT_EQ(area_text(510.07e12), "510,070,000 km²");
}

// Lengths of units: a foot 0.3048 m, a statute mile 5,280 ft, a nautical mile 1,852 m, by their definitions.
TEST(LengthText, IsInTheUnitsOfTheUser) {
  EXPECT_EQ(length_text(100.0 * 0.3048, LengthUnits::imperial), "100 ft");
  EXPECT_EQ(length_text(999.0 * 0.3048, LengthUnits::imperial), "999 ft");
  EXPECT_EQ(length_text(26.2 * 5280.0 * 0.3048, LengthUnits::imperial), "26.2 mi");
  EXPECT_EQ(length_text(-500.0, LengthUnits::nautical), "-500 m");
  EXPECT_EQ(length_text(60.0 * 1852.0, LengthUnits::nautical), "60 NM");
  EXPECT_EQ(area_text(90.0, LengthUnits::imperial), "969 ft²");
  EXPECT_EQ(area_text(640.0 * 4046.8564224, LengthUnits::imperial), "1 mi²") << "640 acres";
  EXPECT_EQ(area_text(1.0e6, LengthUnits::nautical), "0.29 NM²");
}

TEST(HeightText, IsWhole) {
  EXPECT_EQ(height_text(4478.3), "4,478 m");
  EXPECT_EQ(height_text(-0.3), "0 m");
  EXPECT_EQ(height_text(-10935.0), "-10,935 m");
  EXPECT_EQ(height_text(8848.86, LengthUnits::imperial), "29,032 ft");
  EXPECT_EQ(height_text(4478.3, LengthUnits::nautical), "4,478 m");
}

TEST(ScaleBar, IsRoundInTheUnitsOfTheUser) {
  for (const LengthUnits units : {LengthUnits::imperial, LengthUnits::nautical}) {
    for (double height_m = 2.0; height_m < 1e8; height_m *= 1.7) {
      const View view = make_view(down(46, 7, height_m), earth().ellipsoid, {1024, 768});
      const auto bar = scale_bar(view, earth().ellipsoid, 150.0, units);
      ASSERT_TRUE(bar.has_value());
      EXPECT_LE(bar->width_px, 150.0 + 1e-9);
      EXPECT_GT(bar->width_px, 150.0 / 5.0 - 1e-9) << "a mile may be less than a thousand feet more";
      std::string digits = bar->text.substr(0, bar->text.find(' '));
      std::erase_if(digits, [](char letter) { return letter == ',' || letter == '.' || letter == '0'; });
      EXPECT_TRUE(digits == "1" || digits == "2" || digits == "5") << bar->text;
    }
  }
}

TEST(ScaleBar, IsARoundLengthThatFits) {
  for (double height_m = 2.0; height_m < 1e8; height_m *= 1.7) {
    const View view = make_view(down(46, 7, height_m), earth().ellipsoid, {1024, 768});
    const auto bar = scale_bar(view, earth().ellipsoid, 150.0);
    ASSERT_TRUE(bar.has_value());
    EXPECT_LE(bar->width_px, 150.0);
    EXPECT_GT(bar->width_px, 150.0 / 2.5 - 1e-9);  // 2 to 5 is the widest gap
    const double digit = bar->length_m / std::pow(10.0, std::floor(std::log10(bar->length_m) + 1e-9));
    EXPECT_TRUE(std::abs(digit - 1) < 1e-9 || std::abs(digit - 2) < 1e-9 || std::abs(digit - 5) < 1e-9) << digit;
    EXPECT_NEAR(bar->length_m / bar->width_px, height_m / view.pixels_per_radian(), 1e-6 * height_m);
  }
}

TEST(ScaleBar, IsAbsentInTheSky) {
  Camera up = down(46, 7, 1e3);
  up.pitch = Angle::degrees(60.0);
  EXPECT_FALSE(scale_bar(make_view(up, earth().ellipsoid, {1024, 768}), earth().ellipsoid, 150.0).has_value());
}

TEST(CameraText, ReadsBackAsTheSameCamera) {
  Camera camera = down(-89.99999912345678, 179.99999999999, 1.0 / 3.0);
  camera.heading = Angle::degrees(-123.456789012345);
  camera.pitch = Angle::degrees(-17.3);
  const auto back = parse_camera(camera_text(camera));
  ASSERT_TRUE(back.ok());
  constexpr double kUlps_deg = 1e-13;  // rounding of 180°, through radians and back
  EXPECT_NEAR(back->eye.lat.deg(), camera.eye.lat.deg(), kUlps_deg);
  EXPECT_NEAR(back->eye.lon.deg(), camera.eye.lon.deg(), kUlps_deg);
  EXPECT_EQ(back->eye.height_m, camera.eye.height_m);
  EXPECT_NEAR(back->heading.deg(), camera.heading.deg(), kUlps_deg);
  EXPECT_NEAR(back->pitch.deg(), camera.pitch.deg(), kUlps_deg);
}

TEST(ClickPair, NeedsTwoPressesCloseInTimeAndPlace) {
  ClickPair clicks;
  EXPECT_FALSE(clicks.press({10, 10}, Seconds(1.0), 6.0));
  EXPECT_TRUE(clicks.press({12, 11}, Seconds(1.3), 6.0));
  EXPECT_FALSE(clicks.press({12, 11}, Seconds(1.4), 6.0));  // the third begins a new pair
  EXPECT_FALSE(clicks.press({12, 11}, Seconds(2.0), 6.0));  // too late
  EXPECT_FALSE(clicks.press({40, 11}, Seconds(2.1), 6.0));  // too far
  EXPECT_FALSE(clicks.press({40, 11}, Seconds(0.0), 6.0));  // the clock went back
}

TEST(ScreenshotName, IsTheLocalTimeAndNeverAnExistingFile) {
  const auto name = new_file_name("/nonexistent", std::chrono::system_clock::now()).filename().string();
  EXPECT_EQ(name.size(), std::string("terrella-20260101-000000.png").size());
  EXPECT_EQ(name.substr(0, 9), "terrella-");
  EXPECT_EQ(name.substr(name.size() - 4), ".png");
}

}  // namespace
}  // namespace terrella
