// Air over grey ground and at the horizon beside marched rays; no seam, no bands, and the imagery's own colours by day.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "air_fixture.h"
#include "tests/gl/painted_heights.h"
#include "tiles/elevation_source.h"

namespace terrella::test {
namespace {

constexpr double kGrey = 128.0;

/// Steps from pixel to pixel down a column, across the horizon, and the greatest of them.
struct Steps {
  double drawn = 0.0, truth = 0.0;
  void add(const glm::dvec3& drawn_step, const glm::dvec3& truth_step) {
    for (int c = 0; c < 3; ++c) {
      drawn = std::max(drawn, std::abs(drawn_step[c]));
      truth = std::max(truth, std::abs(truth_step[c]));
    }
  }
};

class AirLook : public AirPictures {
 protected:
  static glm::dvec3 levels(const Color& c) { return {c[0], c[1], c[2]}; }
  /// Ground within 5° of a latitude and up to 60°N around noon, under a satellite's angles.
  static bool is_pictured_at_noon(const View& view, double lat_deg, glm::dvec2 px) {
    constexpr double kSatellite_deg = 34.0;
    const auto place = pick(view, earth().ellipsoid, px);
    if (!place || std::abs(place->lat.deg() - lat_deg) > 5.0 || place->lat.deg() > 60.0) return false;
    if (std::abs(place->lon.deg()) > 10.0) return false;
    const glm::dvec3 normal = Ellipsoid::normal(place->lat, place->lon).xyz;
    return -glm::dot(normal, pixel_ray(view, px).xyz) > std::cos(glm::radians(kSatellite_deg));
  }
  /// The last row of the sky in a column; nothing without a horizon in it.
  static std::optional<int> horizon_row(const View& view, const Ellipsoid& e, int x) {
    for (int y = 1; y < kSize.height_px; ++y) {
      if (pick(view, e, {x + 0.5, y + 0.5}) && !pick(view, e, {x + 0.5, y - 0.5})) return y - 1;
    }
    return std::nullopt;
  }
  /// Both pictures around the horizon, without Sun and Moon.
  Steps steps_at(const AirTruth& truth, const View& view, const Ellipsoid& e, int x, Sum& sum) {
    Steps steps;
    const auto row = horizon_row(view, e, x);
    if (!row) return steps;
    const Picture seen = picture();
    std::optional<glm::dvec3> before, truth_before;
    for (int y = std::max(0, *row - 3); y <= std::min(kSize.height_px - 1, *row + 4); ++y) {
      const std::optional<glm::dvec3> here = truth_at(truth, view, {x, y}, kGrey, 8);
      const glm::dvec3 drawn = levels(seen.at(x, y));
      if (here && truth_before) steps.add(drawn - *before, *here - *truth_before);
      for (int c = 0; here && c < 3; ++c) sum.squares += (drawn - *here)[c] * (drawn - *here)[c], ++sum.count;
      before = drawn;
      truth_before = here;
    }
    return steps;
  }
};

// Half a level of dither and half a level of rounding on both sides of a step. The other three are for ground by night:
// the globe mixes squares of stored colours, which is not sRGB's law near black.
TEST_F(AirLook, HasNoSeamBetweenGreyGroundAndSky) {
  constexpr double kStep_levels = 5.0, kStep_part = 1.1;
  Sum all;
  int columns = 0, views = 0;
  for (const char* name : {"earth", "mars", "titan"}) {
    const Body body = *parse_body(name);
    const AirTruth truth(*atmosphere_of(body), body.ellipsoid);
    const auto globe = globe_with_air(body, static_cast<std::uint8_t>(kGrey));
    for (const AirView& v : air_views(body.ellipsoid)) {
      globe->set_camera(camera(v));
      settle(*globe, kSize);
      const View view = make_view(camera(v), body.ellipsoid, kSize);
      Sum one = compare(truth, view, kGrey);
      for (const int x : {20, 75}) {
        const Steps steps = steps_at(truth, view, body.ellipsoid, x, one);
        columns += steps.truth > 0.0 ? 1 : 0;
        EXPECT_LE(steps.drawn, kStep_part * steps.truth + kStep_levels)
            << name << " from " << v.height_m << " m, Sun at " << v.sun_deg << ", column " << x;
      }
      EXPECT_LE(one.rms(), kOne_levels) << name << " from " << v.height_m << " m, Sun at " << v.sun_deg;
      all.squares += one.squares;
      all.count += one.count;
      ++views;
    }
  }
  EXPECT_GE(views, 40);
  EXPECT_GT(columns, 60) << "no horizon";
  EXPECT_LE(all.rms(), kAll_levels);
  RecordProperty("rms_levels", std::to_string(all.rms()));
  std::printf("RMS %.2f levels over %d views of grey ground, %d columns across the horizon\n", all.rms(), views,
              columns);
}

// A colour that changes by a level in many pixels would be a band that wide. Dithered, its pixels alternate.
TEST_F(AirLook, HasNoBands) {
  constexpr int kEven_px = 6;
  const auto globe = globe_with_air(earth(), static_cast<std::uint8_t>(kGrey));
  // The clear sky high over the horizon, and the ground far under the eye.
  for (const AirView& v : {AirView{1.0, 30.0, 140.0, 50.0, 8.0}, AirView{3.0e5, 30.0, 140.0, -50.0, 8.0}}) {
    SCOPED_TRACE("from " + std::to_string(v.height_m) + " m");
    globe->set_camera(camera(v));
    settle(*globe, kSize);
    const Picture seen = picture();
    for (std::size_t c = 0; c < 3; ++c) {
      // Two even stretches that meet are a step that an eye sees.
      int steps = 0, low = 255, high = 0;
      for (int x = 0; x < kSize.width_px; ++x) {
        int run = 0, before = 0;
        for (int y = 0; y < kSize.height_px; ++y) {
          const int here = seen.at(x, y)[c];
          low = std::min(low, here), high = std::max(high, here);
          const bool same = y > 0 && here == seen.at(x, y - 1)[c];
          if (!same) before = run;
          run = same ? run + 1 : 1;
          steps += run == kEven_px && before >= kEven_px ? 1 : 0;
        }
      }
      EXPECT_GT(high, low) << "no gradient";
      EXPECT_EQ(steps, 0) << "channel " << c << " from " << low << " to " << high << " has bands";
    }
  }
}

// Straight down and up to a satellite's 34 degrees aside, at noon in summer and at an equinox.
TEST_F(AirLook, LeavesImageryItsOwnColoursAtNoon) {
  constexpr int kOff_levels = 10;
  for (const char* time : {"2026-06-21T12:00Z", "2026-03-20T12:00Z"}) {
    for (const Color& own :
         {Color{128, 128, 128}, Color{60, 90, 40}, Color{200, 170, 120}, Color{12, 30, 80}, Color{250, 250, 250}}) {
      GlobeOptions options;
      options.sky = true;
      options.time = *parse_utc(time);
      options.surface.glint = false;  // the sea mirrors the Sun, which is no colour of the imagery
      const auto globe = make_globe(options, one_colour({.tile_px = 64, .max_level = 1}, own));
      for (const auto& [lat_deg, height_m] : {std::pair{45.0, 1.0e3}, {45.0, 4.0e5}, {35.0, 3.0e6}, {58.0, 3.0e6}}) {
        globe->set_camera(camera_at(lat_deg, 0.0, height_m, 0.0, -90.0, 40.0));
        settle(*globe, kSize);
        const Picture seen = picture();
        const View view = globe->view(kSize);
        int worst = 0;
        for (int k = 0; k < kSize.width_px * kSize.height_px; ++k) {
          const glm::ivec2 px(k % kSize.width_px, k / kSize.width_px);
          if (!is_pictured_at_noon(view, lat_deg, glm::dvec2(px) + 0.5)) continue;
          const Color c = seen.at(px.x, px.y);
          for (std::size_t i = 0; i < 3; ++i) worst = std::max(worst, std::abs(int(c[i]) - int(own[i])));
        }
        EXPECT_LE(worst, kOff_levels) << time << ", " << int(own[0]) << " " << int(own[1]) << " " << int(own[2])
                                      << " from " << height_m << " m";
      }
    }
  }
}

// Water has no air: over a sea floor the air is that over the sea's surface, but for rays that meet the floor further
// on.
TEST_F(AirLook, OverASeaFloorIsThatOverTheSea) {
  constexpr int kOff_levels = 8;
  GlobeOptions options;
  options.sky = true;
  const auto globe = make_globe(options, one_colour({.tile_px = 64, .max_level = 1}, {12, 30, 80}));
  const auto floor = ElevationSource::open(
      painted_heights({.tile_px = 64, .max_level = 1}, [](double, double) { return -5000.0; }), "floor");
  ASSERT_TRUE(floor);
  for (const double height_m : {3.0e5, 8.0e5, 3.0e6}) {
    for (const double pitch_deg : {-90.0, -70.0, -50.0}) {
      ASSERT_TRUE(globe->set_elevation({}));
      globe->set_camera(camera_at(20.0, -155.0, height_m, 0.0, pitch_deg, 40.0));
      settle(*globe, kSize);
      const Picture sea = picture();
      ASSERT_TRUE(globe->set_elevation(*floor));
      settle(*globe, kSize);
      const Picture seen = picture();
      int worst = 0;
      for (int k = 0; k < kSize.width_px * kSize.height_px; ++k) {
        const Color a = sea.at(k % kSize.width_px, k / kSize.width_px),
                    b = seen.at(k % kSize.width_px, k / kSize.width_px);
        for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(int(a[c]) - int(b[c])));
      }
      EXPECT_LE(worst, kOff_levels) << "from " << height_m << " m, pitch " << pitch_deg;
    }
  }
}

}  // namespace
}  // namespace terrella::test
