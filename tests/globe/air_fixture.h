#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <optional>

#include "air_truth.h"
#include "sky/almanac.h"
#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {

/// Limits of the RMS difference: over all views, the least that a person can tell, and in one view.
inline constexpr double kAll_levels = 2.0, kOne_levels = 5.0;

/// An eye's height and direction, and the height of the Sun over it.
struct AirView {
  double height_m, sun_deg, azimuth_deg, pitch_deg, fov_deg;
};

/// The pitch of a look at the horizon, degrees.
inline double horizon_pitch(const Ellipsoid& e, double height_m) {
  return -std::acos(e.a_m() / (e.a_m() + height_m)) * 180.0 / std::numbers::pi;
}

// Heights from 1 m to 10^8 m, the Sun from noon to 12 degrees under the horizon, looks towards the Sun and away from
// it.
inline std::vector<AirView> air_views(const Ellipsoid& e) {
  std::vector<AirView> views;
  const double heights[] = {1.0, 100.0, 3.0e3, 3.0e4, 2.0e5, 1.0e6, 1.0e8};
  const double suns[] = {80.0, 30.0, 5.0, 0.0, -4.0, -8.0, -12.0};
  int k = 0;
  for (const double h : heights) {
    for (const double sun : {suns[k % 7], suns[(k + 3) % 7]}) {
      const double fov = h > 1.0e7 ? 6.0 : h > 5.0e5 ? 20.0 : 60.0;
      views.push_back(
          {h, sun, k % 2 == 0 ? 35.0 : 140.0, horizon_pitch(e, h) + (h > 1.0e7 ? 0.5 : 4.0) - 2.0 * (k % 3), fov});
      ++k;
    }
  }
  return views;
}

struct Sum {
  double squares = 0.0;
  int count = 0;
  [[nodiscard]] double rms() const { return std::sqrt(squares / std::max(1, count)); }
};

/// Globes with air on the equator, and the colours that marched rays give them.
class AirPictures : public GlTest {
 protected:
  static constexpr Viewport kSize{96, 72};
  static constexpr const char* kTime = "2026-03-20T14:46:00Z";  // the Sun stands over the equator
  static constexpr double kSunGlow_rad = 0.055;                 // ten radii of the Sun's disc, and a pixel

  std::unique_ptr<Globe> globe_with_air(const Body& body, std::uint8_t ground) {
    GlobeOptions options;
    options.body = body;
    options.sky = true;
    options.time = *parse_utc(kTime);
    auto globe = make_globe(options, one_colour({.tile_px = 64, .max_level = 1}, {ground, ground, ground}));
    almanac_ = *almanac_at(*options.time);
    return globe;
  }

  // On the equator, west or east of the Sun.
  [[nodiscard]] Camera camera(const AirView& v) const {
    const double sun_lon = glm::degrees(std::atan2(almanac_.sun.xyz.y, almanac_.sun.xyz.x));
    return {
        .eye = {.lat = Angle::degrees(0.0), .lon = Angle::degrees(sun_lon + 90.0 - v.sun_deg), .height_m = v.height_m},
        .heading = Angle::degrees(270.0 + v.azimuth_deg),
        .pitch = Angle::degrees(std::clamp(v.pitch_deg, -90.0, 90.0)),
        .fov_y = Angle::degrees(v.fov_deg)};
  }

  // The mean of some rays, as stored colours; nothing where Sun or Moon shine.
  [[nodiscard]] std::optional<glm::dvec3> truth_at(const AirTruth& truth, const View& view, glm::ivec2 px,
                                                   double ground, int rays = 4) const {
    glm::dvec3 sum(0.0);
    for (int k = 0; k < rays; ++k) {
      const glm::dvec2 at(px.x + 0.5, px.y + (k + 0.5) / rays);
      const glm::dvec3 ray = pixel_ray(view, at).xyz;
      const glm::dvec3 moon = glm::normalize(almanac_.moon.xyz_m - view.eye.xyz_m);
      if (glm::dot(ray, almanac_.sun.xyz) > std::cos(kSunGlow_rad) || glm::dot(ray, moon) > std::cos(0.02))
        return std::nullopt;
      sum += truth.color(view.eye.xyz_m, ray, almanac_.sun.xyz, ground);
    }
    return sum / double(rays);
  }

  Sum compare(const AirTruth& truth, const View& view, double ground) {
    const Picture seen = picture();
    Sum sum;
    for (int y = 1; y < kSize.height_px; y += 6) {
      for (int x = 5; x < kSize.width_px; x += 28) {
        const auto expected = truth_at(truth, view, {x, y}, ground);
        if (!expected) continue;
        for (int c = 0; c < 3; ++c) {
          const double off = double(seen.at(x, y)[static_cast<std::size_t>(c)]) - (*expected)[c];
          sum.squares += off * off;
          ++sum.count;
        }
      }
    }
    return sum;
  }

  Almanac almanac_{};
};

}  // namespace terrella::test
