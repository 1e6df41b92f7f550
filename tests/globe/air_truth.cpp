#include "air_truth.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <utility>

namespace terrella::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kSteps = 80, kSunSteps = 24, kAroundSteps = 24;
constexpr int kHeights = 12, kElevations = 32;  // grid of light from around
constexpr double kSunRadius_rad = 0.00465;

struct Crossing {
  double first, last;
};

// Crossings of a ray with the ellipsoid raised by a height: distances, which may be negative.
std::optional<Crossing> crossing(const Ellipsoid& e, double height_m, const glm::dvec3& from, const glm::dvec3& ray) {
  const glm::dvec3 axes(e.a_m() + height_m, e.a_m() + height_m, e.b_m() + height_m);
  const glm::dvec3 p = from / axes, d = ray / axes;
  const double t = -glm::dot(p, d) / glm::dot(d, d);
  const glm::dvec3 nearest = p + t * d;
  const double free = 1.0 - glm::dot(nearest, nearest);
  if (free < 0.0) return std::nullopt;
  const double half = std::sqrt(free / glm::dot(d, d));
  return Crossing{t - half, t + half};
}

double stored(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
}

double linear(double stored) { return stored <= 0.04045 ? stored / 12.92 : std::pow((stored + 0.055) / 1.055, 2.4); }

double elevation_of(int k) {
  const double x = 2.0 * k / (kElevations - 1.0) - 1.0;  // closest at the horizon
  return 0.5 * kPi * x * std::abs(x);
}

}  // namespace

AirTruth::AirTruth(const Atmosphere& air, const Ellipsoid& body) : air_(air), body_(body) { make_around(); }

AirTruth::Coefficients AirTruth::at(double height_m) const {
  const double h = std::max(0.0, height_m), gas = std::exp(-h / air_.gas_scale_m),
               dust = std::exp(-h / air_.dust_scale_m);
  const double ozone = std::max(0.0, 1.0 - std::abs(h - air_.ozone_height_m) / air_.ozone_half_width_m);
  return {gas * air_.gas_scatter_per_m, dust * air_.dust_scatter_per_m,
          gas * air_.gas_scatter_per_m + dust * air_.dust_extinct_per_m + ozone * air_.ozone_absorb_per_m};
}

// Along the line to the centre, which at these heights is within metres of the normal.
double AirTruth::height_m(const glm::dvec3& p) const {
  const glm::dvec3 axes(body_.a_m(), body_.a_m(), body_.b_m());
  return glm::length(p) * (1.0 - 1.0 / glm::length(p / axes));
}

glm::dvec3 AirTruth::sunlight(const glm::dvec3& p, const glm::dvec3& sun) const {
  const double h = std::max(1.0, height_m(p)), r = glm::length(p);
  const double elevation = std::asin(std::clamp(glm::dot(p, sun) / r, -1.0, 1.0));
  const double dip = std::acos((r - h) / r), over = (elevation + dip) / kSunRadius_rad;
  if (over <= -1.0) return glm::dvec3(0.0);
  // The part of a disc over a straight edge.
  const double y = std::min(over, 1.0), part = 0.5 + (y * std::sqrt(1.0 - y * y) + std::asin(y)) / kPi;
  const auto end = crossing(body_, air_.top_m, p, sun);
  if (!end || end->last <= 0.0) return glm::dvec3(part);
  glm::dvec3 depth(0.0);
  // Steps grow away from the place, or from the lowest point of the ray.
  const double low = std::max(0.0, -glm::dot(p, sun));
  for (int k = 0; k < kSunSteps; ++k) {
    const auto place = [&](double s) {
      return s < 0.5 ? low * (1.0 - (1.0 - 2.0 * s) * (1.0 - 2.0 * s))
                     : low + (end->last - low) * (2.0 * s - 1.0) * (2.0 * s - 1.0);
    };
    const bool level = low == 0.0;
    const double s = level ? 0.5 + 0.5 * k / kSunSteps : double(k) / kSunSteps, ds = (level ? 0.5 : 1.0) / kSunSteps;
    const double a = place(s), b = place(s + ds);
    depth += at(height_m(p + 0.5 * (a + b) * sun)).extinct * (b - a);
  }
  return part * glm::exp(-depth);
}

glm::dvec3 AirTruth::around_place(const glm::dvec3& p, const glm::dvec3& sun) const {
  constexpr int kZeniths = 8, kAzimuths = 6;
  const glm::dvec3 up = glm::normalize(p);
  glm::dvec3 second(0.0), again(0.0);
  for (int z = 0; z < kZeniths; ++z) {
    const double c = 1.0 - (2.0 * z + 1.0) / kZeniths, s = std::sqrt(1.0 - c * c);
    for (int a = 0; a < kAzimuths; ++a) {
      const double turn = kPi * (a + 0.5) / kAzimuths;  // the Sun lies in the plane y = 0
      const glm::dvec3 ray = c * up + s * (std::cos(turn) * glm::dvec3(1, 0, 0) + std::sin(turn) * glm::dvec3(0, 1, 0));
      const auto ground = crossing(body_, 0.0, p, ray);
      const bool meets = ground && ground->first > 0.0;
      const double length = meets ? ground->first : crossing(body_, air_.top_m, p, ray)->last;
      glm::dvec3 passed(1.0);
      for (int k = 0; k < kAroundSteps; ++k) {
        const double from = length * k * k / (kAroundSteps * kAroundSteps),
                     to = length * (k + 1) * (k + 1) / (kAroundSteps * kAroundSteps);
        const glm::dvec3 q = p + 0.5 * (from + to) * ray;
        const Coefficients here = at(height_m(q));
        const glm::dvec3 step = glm::exp(-here.extinct * (to - from));
        const glm::dvec3 scattered =
            passed * (1.0 - step) / glm::max(here.extinct, glm::dvec3(1e-30)) * (here.gas + here.dust);
        again += scattered;
        second += scattered * sunlight(q, sun) / (4.0 * kPi);
        passed *= step;
      }
      if (!meets) continue;
      const glm::dvec3 q = p + length * ray;
      const double cosine = std::max(0.0, glm::dot(glm::normalize(q), sun));
      second += passed * kGroundAlbedo / kPi * cosine * sunlight(q, sun);
    }
  }
  constexpr double kRays = kZeniths * kAzimuths;
  return second / kRays / (1.0 - glm::min(again / kRays, glm::dvec3(0.99)));
}

// On the equator, so that the planet's figure does not matter.
void AirTruth::make_around() {
  for (int i = 0; i < kHeights; ++i) {
    const double h = air_.top_m * std::max(1e-6, double(i * i) / ((kHeights - 1) * (kHeights - 1)) * 0.9999);
    for (int k = 0; k < kElevations; ++k) {
      const double e = elevation_of(k);
      around_.push_back(around_place({0.0, 0.0, body_.b_m() + h}, {std::cos(e), 0.0, std::sin(e)}));
    }
  }
}

glm::dvec3 AirTruth::around(double height_m, double elevation_rad) const {
  const double x = elevation_rad / (0.5 * kPi);
  const double u = (0.5 + 0.5 * std::copysign(std::sqrt(std::abs(x)), x)) * (kElevations - 1);
  const double v = std::sqrt(std::clamp(height_m / air_.top_m, 0.0, 1.0)) * (kHeights - 1);
  const int i = std::clamp(int(u), 0, kElevations - 2), j = std::clamp(int(v), 0, kHeights - 2);
  const auto texel = [&](int a, int b) { return around_[static_cast<std::size_t>(b * kElevations + a)]; };
  return glm::mix(glm::mix(texel(i, j), texel(i + 1, j), u - i), glm::mix(texel(i, j + 1), texel(i + 1, j + 1), u - i),
                  v - j);
}

AirTruth::Seen AirTruth::march(const glm::dvec3& from, const glm::dvec3& ray, double length_m,
                               const glm::dvec3& sun) const {
  const double c = glm::dot(ray, sun);
  const double gas_phase = 3.0 / (16.0 * kPi) * (1.0 + c * c);
  glm::dvec3 dust_phase(0.0);
  for (int k = 0; k < 3; ++k) {
    const double g = air_.dust_forwardness[k];
    dust_phase[k] =
        3.0 / (8.0 * kPi) * (1.0 - g * g) * (1.0 + c * c) / ((2.0 + g * g) * std::pow(1.0 + g * g - 2.0 * g * c, 1.5));
  }
  Seen seen;
  // Steps are shortest around the lowest point of the ray.
  const double low = std::clamp(-glm::dot(from, ray), 0.0, length_m);
  const auto place = [&](double s) {
    const double split = std::min(low / length_m, 1.0 - 1e-12);
    const double p = s < split ? 1.0 - s / split : (s - split) / (1.0 - split);
    return s < split ? low * (1.0 - p * p) : low + (length_m - low) * p * p;
  };
  for (int k = 0; k < kSteps; ++k) {
    const double a = place(double(k) / kSteps), b = place((k + 1.0) / kSteps);
    const glm::dvec3 p = from + 0.5 * (a + b) * ray;
    const double h = height_m(p), elevation = std::asin(std::clamp(glm::dot(glm::normalize(p), sun), -1.0, 1.0));
    const Coefficients here = at(h);
    const glm::dvec3 step = glm::exp(-here.extinct * (b - a));
    const glm::dvec3 part = seen.passed * (1.0 - step) / glm::max(here.extinct, glm::dvec3(1e-30));
    seen.light += part * ((here.gas * gas_phase + here.dust * dust_phase) * sunlight(p, sun) +
                          (here.gas + here.dust) * around(h, elevation));
    seen.passed *= step;
  }
  return seen;
}

glm::dvec3 AirTruth::vertical(double from_m, double to_m) const {
  glm::dvec3 depth(0.0);
  constexpr int kParts = 1000;
  for (int k = 0; k < kParts; ++k)
    depth += at(from_m + (to_m - from_m) * (k + 0.5) / kParts).extinct * ((to_m - from_m) / kParts);
  return glm::exp(-depth);
}

glm::dvec3 AirTruth::film(const glm::dvec3& light) const { return 1.0 - glm::exp(-air_.exposure * light); }

glm::dvec3 AirTruth::light_on_ground(double sun_cos) const {
  const double elevation = std::asin(sun_cos);
  const glm::dvec3 place(0.0, 0.0, body_.b_m()), sun(std::cos(elevation), 0.0, sun_cos);
  return sunlight(place, sun) * std::max(0.0, sun_cos) + kPi * around(0.0, elevation) + 1e-5;
}

double AirTruth::sun_cosine(const glm::dvec3& place_m, const glm::dvec3& sun) const {
  const glm::dvec3 axes(body_.a_m(), body_.a_m(), body_.b_m());
  return glm::dot(glm::normalize(place_m / (axes * axes)), sun);
}

// A picture's colours are those under a Sun 20 degrees high.
glm::dvec3 AirTruth::ground_tint(const glm::dvec3& place_m, const glm::dvec3& sun) const {
  constexpr double kPictured_cos = 0.35;
  const double cosine = sun_cosine(place_m, sun);
  const glm::dvec3 tint = light_on_ground(std::min(cosine, kPictured_cos)) / light_on_ground(kPictured_cos);
  const glm::dvec3 part = tint / std::max({tint.r, tint.g, tint.b});
  return {stored(part.r), stored(part.g), stored(part.b)};
}

// The globe's look: a quarter of the light by night, which begins at the end of civil twilight.
glm::dvec3 AirTruth::ground_light(const glm::dvec3& place_m, const glm::dvec3& sun) const {
  const double light =
      glm::mix(0.25, 1.0, glm::smoothstep(-std::sin(glm::radians(6.0)), 0.3, sun_cosine(place_m, sun)));
  return light * ground_tint(place_m, sun);
}

glm::dvec3 AirTruth::thing(const glm::dvec3& eye_m, const glm::dvec3& ray, double distance_m, const glm::dvec3& sun,
                           const glm::dvec3& thing_srgb) const {
  const auto air = crossing(body_, air_.top_m, eye_m, ray);
  if (!air || air->last <= 0.0) return thing_srgb;
  const double begin = std::max(0.0, air->first), end = std::min(distance_m, air->last);
  if (end <= begin) return thing_srgb;
  const Seen seen = march(eye_m + begin * ray, ray, std::max(end - begin, 1e-3), sun);
  // A picture of the ground is taken through 1.2 times the air over it.
  const auto height = [&](const glm::dvec3& p) { return std::clamp(height_m(p), 0.0, air_.top_m); };
  const std::pair<double, double> ends = std::minmax({height(eye_m), height(eye_m + distance_m * ray)});
  const glm::dvec3 under = glm::pow(vertical(ends.first, ends.second), glm::dvec3(1.2));
  const glm::dvec3 left = glm::min(glm::dvec3(1.0), seen.passed / under);
  const glm::dvec3 light = film(seen.light * (1.0 - left) / glm::max(1.0 - seen.passed, glm::dvec3(1e-12)));
  glm::dvec3 out;
  for (int k = 0; k < 3; ++k)
    out[k] = 255.0 * stored(linear(thing_srgb[k] / 255.0) * left[k] * (1.0 - light[k]) + light[k]);
  return out;
}

glm::dvec3 AirTruth::color(const glm::dvec3& eye_m, const glm::dvec3& ray, const glm::dvec3& sun,
                           double ground_srgb) const {
  const auto ground = crossing(body_, 0.0, eye_m, ray), air = crossing(body_, air_.top_m, eye_m, ray);
  if (!air || air->last <= 0.0) return glm::dvec3(0.0);
  if (ground && ground->first > 0.0) {
    const glm::dvec3 own = ground_srgb * ground_light(eye_m + ground->first * ray, sun);
    return thing(eye_m, ray, ground->first, sun, own);
  }
  const double begin = std::max(0.0, air->first);
  const glm::dvec3 light = film(march(eye_m + begin * ray, ray, std::max(air->last - begin, 1e-3), sun).light);
  return {255.0 * stored(light.r), 255.0 * stored(light.g), 255.0 * stored(light.b)};
}

}  // namespace terrella::test
