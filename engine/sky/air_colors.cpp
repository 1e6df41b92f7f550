#include "sky/air_colors.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <numbers>
#include <span>

namespace terrella {
namespace {

// From outside, the air is a thin ring. It has as many rows and columns as its pixels can show: a row a pixel, and
// chords that leave the circle by a twentieth of a pixel. From inside, the air is a dome. Its brightest part, around
// the Sun, needs steps of a few degrees.
constexpr int kRingRows = 24, kLeastRingRows = 10, kRingColumns = 65, kRingTurn = 512, kLeastRingTurn = 128;
constexpr double kRowsAPixel = 1.0, kChord_px = 0.05;
// Least distance of two rows, in pixels and in heights over which the air thins out to a third, whichever is more.
constexpr double kRowStep_px = 0.5, kRowStep_scales = 0.15;
// A ring of fewer pixels is one strip of triangles, with the colours looked up per pixel: many rows would be slivers,
// each of which a rasteriser shades in squares of several pixels.
constexpr double kThinRing_px = 16.0, kThinRow_px = 0.5;
constexpr int kDomeRows = 48, kDomeColumns = 61, kDomeTurn = 120;
constexpr int kGroundSteps = 20;
// Satellites look up to 34 degrees away from the vertical, through this many vertical air masses.
constexpr float kPicturedAirMass = 1.2F;

glm::vec3 encoded_srgb(const glm::vec3& linear) {
  glm::vec3 c(0.0F);
  for (int k = 0; k < 3; ++k) {
    const float x = std::clamp(linear[k], 0.0F, 1.0F);
    c[k] = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
  }
  return c;
}

// Light on film, 0...1.
glm::vec3 on_film(const glm::vec3& light, const Atmosphere& air) {
  return 1.0F - glm::exp(-static_cast<float>(air.exposure) * light);
}

/// Cosine of the angle between a ray and the Sun.
double sun_cosine(const AirEye& eye, double sine, double cosine, double azimuth_cos) {
  const double sun_sin = std::sqrt(std::max(0.0, 1.0 - squared(eye.sun_cos)));
  return sine * sun_sin * azimuth_cos + cosine * eye.sun_cos;
}

// Part of a stored colour that passes: light on a screen of gamma 2.2.
glm::vec3 stored_part(const glm::vec3& transmitted) { return glm::pow(transmitted, glm::vec3(1.0F / 2.2F)); }

/// A profile over the limb: colours at the heights of SkyTable's rows, linear between them, and their integral.
class LimbProfile {
 public:
  LimbProfile(double top_height, double below)
      : top_(top_height), below_(below), colors_(SkyTable::kRows), sums_(SkyTable::kRows) {}
  glm::vec3& color(int row) { return colors_[static_cast<std::size_t>(row)]; }
  void sum_up() {
    for (std::size_t k = 1; k < colors_.size(); ++k) {
      const auto length = static_cast<float>(height(k) - height(k - 1));
      sums_[k] = sums_[k - 1] + 0.5F * length * (colors_[k - 1] + colors_[k]);
    }
  }
  /// Integral from the limb to a height; 0 under the limb's colour. `beyond` is the colour above the air.
  [[nodiscard]] glm::vec3 integral(double h, const glm::vec3& beyond) const {
    if (h <= 0.0) return colors_.front() * static_cast<float>(std::max(h, -below_));
    if (h >= top_) return sums_.back() + beyond * static_cast<float>(h - top_);
    const double row = std::sqrt(h / top_) * (SkyTable::kRows - 1.0);
    const auto k = std::min(static_cast<std::size_t>(row), colors_.size() - 2);
    const double part = (h - height(k)) / (height(k + 1) - height(k));
    const glm::vec3 here = glm::mix(colors_[k], colors_[k + 1], static_cast<float>(part));
    return sums_[k] + 0.5F * static_cast<float>(h - height(k)) * (colors_[k] + here);
  }
  /// Mean over a pixel around a height.
  [[nodiscard]] glm::vec3 mean(double h, double pixel, const glm::vec3& beyond) const {
    return (integral(h + 0.5 * pixel, beyond) - integral(h - 0.5 * pixel, beyond)) / static_cast<float>(pixel);
  }

 private:
  [[nodiscard]] double height(std::size_t row) const { return top_ * squared(double(row) / (SkyTable::kRows - 1.0)); }
  double top_, below_;
  std::vector<glm::vec3> colors_, sums_;
};

/// The ring of air beside the globe, seen from outside.
class Ring {
 public:
  Ring(const AirTables& air, const AirEye& eye, double pixel, double below)
      : air_(air),
        eye_(eye),
        top_(air.top() - 1.0),
        pixel_(std::max(pixel, 1e-6 * top_)),
        lowest_(-(below + 0.05 * top_ + pixel_)),
        below_(below > 0.0 ? pixel_ - lowest_ : 0.0),
        thin_(is_thin()),
        rows_(static_cast<int>(
            thin_ ? 2.0 + (top_ + pixel_ - lowest_) / (kThinRow_px * pixel_)
                  : std::clamp(4.0 + kRowsAPixel * (top_ / pixel_ + 1.0), double(kLeastRingRows), double(kRingRows)))),
        turn_(2 * static_cast<int>(std::clamp(0.5 * std::numbers::pi / std::sqrt(2.0 * kChord_px * pixel_),
                                              0.5 * kLeastRingTurn, 0.5 * kRingTurn))) {}

  SkyColors colors() {
    SkyColors c{.outside = true, .turn = turn_, .columns = kRingColumns, .rows = rows_, .thin = thin_};
    c.light_srgb.resize(static_cast<std::size_t>(c.columns) * static_cast<std::size_t>(c.rows));
    c.limb_light_sum.resize(static_cast<std::size_t>(c.columns) * SkyColors::kLimbRows);
    for (int row = 0; row < rows_; ++row) {
      const double sine = std::min(1.0, (1.0 + height(row)) / eye_.radius);
      c.zenith.emplace_back(sine, -std::sqrt(1.0 - sine * sine));
    }
    const SkyTable table = make_sky_table(air_, eye_);
    LimbProfile passed(top_, below_);
    for (int row = 0; row < SkyTable::kRows; ++row) {
      passed.color(row) = stored_part(table.transmitted[static_cast<std::size_t>(row)]);
    }
    passed.sum_up();
    const glm::vec3 all(1.0F);
    for (int row = 0; row < rows_; ++row) c.through.emplace_back(passed.mean(height(row), pixel_, all), 0.0F);
    for (int k = 0; k < SkyColors::kLimbRows; ++k) {
      c.limb_through_sum.emplace_back(passed.integral(limb_height(k), all) / float(pixel_), 0.0F);
    }
    for (int column = 0; column < kRingColumns; ++column) add_column(table, column, c);
    return c;
  }

 private:
  // Heights are interpolated along the chord between the directions to the lowest and the highest row.
  [[nodiscard]] bool is_thin() const {
    if (top_ + pixel_ - lowest_ > kThinRing_px * pixel_) return false;
    const auto nadir_rad = [&](double height) { return std::asin(std::min(1.0, (1.0 + height) / eye_.radius)); };
    const double off = squared(nadir_rad(top_ + pixel_) - nadir_rad(lowest_)) / 8.0;
    return off < kChord_px * pixel_;
  }
  // The second and the third row are those where a pixel leaves the globe: a mean grows from the limb's lower side to
  // its upper side. Beyond, rows are closest at the limb, where the air is densest.
  [[nodiscard]] double height(int row) const {
    if (row == 0) return lowest_;
    if (thin_) return lowest_ + (top_ + pixel_ - lowest_) * row / (rows_ - 1.0);
    if (row == 1) return -0.5 * pixel_;
    const double part = (row - 2) / (rows_ - 3.0), whole = top_ + 0.5 * pixel_;
    const double step =
        std::max(kRowStep_px * pixel_, kRowStep_scales * top_ * air_.air().gas_scale_m / air_.air().top_m);
    const double even = std::min(1.0, step * (rows_ - 3.0) / whole);
    return 0.5 * pixel_ + whole * part * (even + (1.0 - even) * part);
  }
  [[nodiscard]] double limb_height(int k) const { return pixel_ * k / SkyColors::kLimbSteps; }

  void add_column(const SkyTable& table, int column, SkyColors& c) const {
    const double azimuth = column / (kRingColumns - 1.0), azimuth_cos = std::cos(std::numbers::pi * azimuth);
    LimbProfile profile(top_, below_);
    for (int row = 0; row < SkyTable::kRows; ++row) {
      const double part = row / (SkyTable::kRows - 1.0), sine = (1.0 + top_ * part * part) / eye_.radius;
      const double to_sun = sun_cosine(eye_, sine, -std::sqrt(std::max(0.0, 1.0 - sine * sine)), azimuth_cos);
      profile.color(row) = encoded_srgb(on_film(radiance(table.at(azimuth, part), air_.air(), to_sun), air_.air()));
    }
    profile.sum_up();
    const glm::vec3 none(0.0F);
    for (int row = 0; row < rows_; ++row) {
      c.light_srgb[static_cast<std::size_t>(row * kRingColumns + column)] =
          glm::vec4(profile.mean(height(row), pixel_, none), 0.0F);
    }
    for (int k = 0; k < SkyColors::kLimbRows; ++k) {
      c.limb_light_sum[static_cast<std::size_t>(k * kRingColumns + column)] =
          glm::vec4(profile.integral(limb_height(k), none) / float(pixel_), 0.0F);
    }
  }

  const AirTables& air_;
  AirEye eye_;
  double top_, pixel_;
  double lowest_;  ///< height of the first row
  double below_;   ///< depth to which the limb's colour goes on
  bool thin_;
  int rows_, turn_;
};

SkyColors dome_colors(const AirTables& air, const AirEye& eye) {
  SkyColors c{.turn = kDomeTurn, .columns = kDomeColumns, .rows = kDomeRows};
  const SkyTable table = make_sky_table(air, eye);
  for (int row = 0; row < kDomeRows; ++row) {
    const double part = std::max(0.0, (row - 1) / (kDomeRows - 2.0)), dip = table.horizon_dip_rad;
    const double elevation = row == 0 ? -dip - 0.05 : part * part * (0.5 * std::numbers::pi + dip) - dip;
    c.zenith.emplace_back(std::cos(elevation), std::sin(elevation));
    const double at = part * (SkyTable::kRows - 1);
    const auto k = std::min(static_cast<std::size_t>(at), table.transmitted.size() - 2);
    const glm::vec3 passed =
        glm::mix(table.transmitted[k], table.transmitted[k + 1], static_cast<float>(at - double(k)));
    c.through.emplace_back(stored_part(passed), 0.0F);
    for (int column = 0; column < kDomeColumns; ++column) {
      const double azimuth = column / (kDomeColumns - 1.0);
      const double angle = std::max(elevation, -dip);
      const double to_sun = sun_cosine(eye, std::cos(angle), std::sin(angle), std::cos(std::numbers::pi * azimuth));
      const glm::vec3 light = radiance(table.at(azimuth, part), air.air(), to_sun);
      c.light_srgb.emplace_back(encoded_srgb(on_film(light, air.air())), 0.0F);
    }
  }
  return c;
}

// Sunlight and skylight on level ground.
glm::vec3 light_on_ground(const AirTables& air, double sun_cos) {
  constexpr glm::vec3 kNight(1e-5F);  // without a colour
  return air.sunlight(1.0, sun_cos) * static_cast<float>(std::max(0.0, sun_cos)) +
         air.skylight(1.0, sun_cos) * static_cast<float>(std::numbers::pi) + kNight;
}

// The colour of the light on the ground, whose brightness the ground's own programs know: red beside the terminator. A
// picture of the ground is taken by day, with the Sun at 20 degrees or more.
glm::vec3 tint_of_ground(const AirTables& air, double sun_cos) {
  constexpr double kPictured_cos = 0.35;
  if (sun_cos >= kPictured_cos) return glm::vec3(1.0F);
  const glm::vec3 color = light_on_ground(air, sun_cos) / light_on_ground(air, kPictured_cos);
  return color / std::max({color.r, color.g, color.b});
}

// The ground's light after `passed` of its own and `light` of the air's, so that black and a middle grey come out as
// they do in light (sRGB decoded).
void add_ground_color(const glm::vec3& passed, const glm::vec3& tint, const glm::vec3& light, GroundColors& c) {
  constexpr float kGrey = 0.5F, kGreyLinear = 0.21404114F;
  const glm::vec3 dark = encoded_srgb(light), grey = encoded_srgb(kGreyLinear * passed * (1.0F - light) + light);
  const glm::vec3 tinted = encoded_srgb(kGreyLinear * tint), tint_sq = tinted * tinted;
  const float sum = tint_sq.r + tint_sq.g + tint_sq.b;
  c.light_sq.emplace_back(dark * dark, tint_sq.g / sum);
  c.through.emplace_back((grey * grey - dark * dark) / (kGrey * kGrey), tint_sq.r / sum);
}

}  // namespace

SkyColors make_sky_colors(const AirTables& air, const AirEye& eye, double pixel, double below) {
  return eye.radius > air.top() ? Ring(air, eye, pixel, below).colors() : dome_colors(air, eye);
}

GroundColors make_ground_colors(const AirTables& air, const AirEye& eye) {
  GroundColors c;
  const glm::vec3 below =
      air.vertical() / (eye.radius < air.top() ? air.transmittance(eye.radius, 1.0) : glm::vec3(1.0F));
  const glm::vec3 pictured = glm::pow(below, glm::vec3(kPicturedAirMass));
  for (int row = 0; row < GroundColors::kRows; ++row) {
    const double v = 1.0 - squared(row / (GroundColors::kRows - 1.0)), down = 1.0 - v * v;  // at the ground
    const double sine = std::sqrt(std::max(0.0, 1.0 - down * down)) / eye.radius;
    const AirRay ray =
        air_ray(air, eye, std::min(sine, 1.0), -std::sqrt(std::max(0.0, 1.0 - sine * sine)), RayEnd::ground);
    const RaySteps steps = ray_steps(air, eye, ray, kGroundSteps);
    const glm::vec3 passed = steps.transmitted, beyond = glm::min(glm::vec3(1.0F), passed / pictured);
    const glm::vec3 share = (1.0F - beyond) / glm::max(1.0F - passed, glm::vec3(1e-6F));
    for (int column = 0; column < GroundColors::kColumns; ++column) {
      const double azimuth_cos = std::cos(std::numbers::pi * column / (GroundColors::kColumns - 1.0));
      const AirLight light = march(air, eye, ray, steps, azimuth_cos);
      const double to_sun = sun_cosine(eye, ray.sine, ray.cosine, azimuth_cos);
      // The Sun over the ground: the eye's place and the ray add up to the ground's.
      const double over_ground = eye.radius * eye.sun_cos + (ray.end - ray.eye) * to_sun;
      add_ground_color(beyond, tint_of_ground(air, over_ground),
                       on_film(share * radiance(light, air.air(), to_sun), air.air()), c);
    }
  }
  return c;
}

}  // namespace terrella
