#include "sky/atmosphere.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace terrella {
namespace {

constexpr int kSkySamples = 18;
// Light of the whole sky relative to the Sun's; blue, because the air scatters blue most.
constexpr glm::dvec3 kSkylight(0.2, 0.28, 0.42);
// Angular radius of the Sun, over which a sunset is spread.
constexpr double kSunSize_rad = 0.00465;

/// The air over a planet of radius 1. Heights and depths are in radii.
class Air {
 public:
  Air(const Atmosphere& air, double radius_m)
      : gas_scatter_(air.gas_scatter_per_m * radius_m),
        dust_scatter_(air.dust_scatter_per_m * radius_m),
        dust_extinct_(air.dust_extinct_per_m * radius_m),
        ozone_depth_(air.ozone_depth),
        gas_scale_(air.gas_scale_m / radius_m),
        dust_scale_(air.dust_scale_m / radius_m),
        ozone_radius_(1.0 + air.ozone_height_m / radius_m),
        top_(1.0 + air.top_m / radius_m) {}

  [[nodiscard]] double top() const { return top_; }
  [[nodiscard]] double gas(double radius) const { return std::exp((1.0 - radius) / gas_scale_); }
  [[nodiscard]] double dust(double radius) const { return std::exp((1.0 - radius) / dust_scale_); }
  [[nodiscard]] const glm::dvec3& gas_scatter() const { return gas_scatter_; }
  [[nodiscard]] const glm::dvec3& dust_scatter() const { return dust_scatter_; }

  // Extinction for densities times lengths, in radii.
  [[nodiscard]] glm::dvec3 extinction(double gas, double dust) const {
    return gas * gas_scatter_ + dust * dust_extinct_;
  }

  // Sunlight that reaches a point at which the Sun has this cosine to the zenith.
  [[nodiscard]] glm::dvec3 sunlight(double radius, double cosine) const {
    const double lowest = radius * std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    double shown = 1.0;
    if (cosine < 0.0) {
      // Height of the ray's lowest point over the ground, in radii of the Sun as seen from the point.
      const double size = kSunSize_rad * std::max(-cosine * radius, 0.01);
      shown = std::clamp(0.5 + 0.5 * (lowest - 1.0) / size, 0.0, 1.0);
      if (shown == 0.0) return glm::dvec3(0.0);
    }
    const glm::dvec3 depth = gas_scatter_ * (gas_scale_ * chapman(gas_scale_, radius, cosine, lowest)) +
                             dust_extinct_ * (dust_scale_ * chapman(dust_scale_, radius, cosine, lowest)) +
                             ozone_depth_ * ozone_path(radius, cosine, lowest);
    return shown * glm::exp(-depth);
  }

  // Light that the air has scattered more than once, from all sides. This is not a model, only an approximation that
  // keeps the zenith blue at sunset and the twilight soft. It acts like a Sun that stands higher, with a border some
  // way into the night.
  [[nodiscard]] glm::dvec3 skylight(double radius, double cosine) const {
    const double t = std::clamp((cosine + 0.2) / 0.35, 0.0, 1.0);
    if (t == 0.0) return glm::dvec3(0.0);
    const double higher = std::max(0.0, (cosine + 0.3) / 1.3);
    return kSkylight * t * t * (3.0 - 2.0 * t) * sunlight(radius, higher);
  }

 private:
  // Density times length along the ray to infinity, in units of ground density times scale height.
  [[nodiscard]] static double chapman(double scale, double radius, double cosine, double lowest) {
    const double c = std::sqrt(radius / scale);
    const double here = std::exp((1.0 - radius) / scale);
    if (cosine >= 0.0) return here * c / (c * cosine + 1.0);
    const double down = 2.0 * std::sqrt(lowest / scale) * std::exp((1.0 - lowest) / scale);
    return std::max(0.0, down - here * c / (1.0 - c * cosine));
  }

  // Length of the path through the ozone layer, relative to the vertical path.
  [[nodiscard]] double ozone_path(double radius, double cosine, double lowest) const {
    const double q = lowest / ozone_radius_;
    if (q >= 1.0) return 0.0;
    const double crossing = 1.0 / std::max(0.1, std::sqrt(1.0 - q * q));
    if (radius < ozone_radius_) return crossing;
    return cosine < 0.0 ? 2.0 * crossing : 0.0;
  }

  glm::dvec3 gas_scatter_, dust_scatter_, dust_extinct_, ozone_depth_;
  double gas_scale_, dust_scale_, ozone_radius_, top_;
};

/// A ray in the plane of the eye and the planet's centre; the eye is at (0, radius).
struct SkyRay {
  double sine, cosine;  ///< sine and cosine of the angle from the zenith
  double begin, end;    ///< range in which the ray is in the air
  double middle;        ///< point at which the air is densest
};

SkyRay ray_of_row(const Air& air, double eye_radius, bool outside, double dip, double part) {
  SkyRay ray{};
  if (outside) {
    const double lowest = 1.0 + part * (air.top() - 1.0);
    ray.sine = lowest / eye_radius;
    ray.cosine = -std::sqrt(std::max(0.0, 1.0 - ray.sine * ray.sine));
  } else {
    const double elevation = part * part * (0.5 * std::numbers::pi + dip) - dip;
    ray.sine = std::cos(elevation);
    ray.cosine = std::sin(elevation);
  }
  const double lowest_at = -eye_radius * ray.cosine;
  const double across = eye_radius * ray.sine;
  const double half = std::sqrt(std::max(0.0, (air.top() - across) * (air.top() + across)));
  ray.begin = std::max(0.0, lowest_at - half);
  ray.end = std::max(ray.begin, lowest_at + half);
  ray.middle = std::clamp(lowest_at, ray.begin, ray.end);
  return ray;
}

/// A piece of a ray.
struct AirSample {
  glm::dvec3 place;
  double radius;
  double gas, dust;  ///< density times length
  glm::dvec3 seen;   ///< fraction of the piece's light that reaches the eye
};

/// The samples of a ray, and its total depth. Samples are closest where the air is densest. Their lengths grow with the
/// square of the distance in both directions.
struct RaySamples {
  std::array<AirSample, kSkySamples> samples;
  glm::dvec3 depth{0.0};
};

RaySamples sample_ray(const Air& air, const SkyRay& ray, double eye_radius) {
  const double before = ray.middle - ray.begin, after = ray.end - ray.middle;
  const int first = before > 0.0 ? kSkySamples / 2 : 0;
  const auto place = [&](int k) {
    const double s = k < first ? 1.0 - double(k) / first : double(k - first) / (kSkySamples - first);
    return ray.middle + (k < first ? -before : after) * s * s;
  };
  RaySamples all;
  for (int k = 0; k < kSkySamples; ++k) {
    const double middle = 0.5 * (place(k) + place(k + 1)), length = place(k + 1) - place(k);
    AirSample& sample = all.samples[static_cast<std::size_t>(k)];
    sample.place = glm::dvec3(middle * ray.sine, 0.0, eye_radius + middle * ray.cosine);
    sample.radius = std::max(1.0, glm::length(sample.place));
    sample.gas = air.gas(sample.radius) * length;
    sample.dust = air.dust(sample.radius) * length;
    const glm::dvec3 step = air.extinction(sample.gas, sample.dust);
    sample.seen = glm::exp(-(all.depth + 0.5 * step));
    all.depth += step;
  }
  return all;
}

struct Scattered {
  glm::dvec3 gas{0.0}, dust{0.0};
};

Scattered gather(const Air& air, const RaySamples& ray, const glm::dvec3& sun) {
  Scattered sum;
  for (const AirSample& sample : ray.samples) {
    const double cosine = glm::dot(sample.place, sun) / sample.radius;
    const glm::dvec3 light = sample.seen * air.sunlight(sample.radius, cosine);
    sum.gas += (light + sample.seen * air.skylight(sample.radius, cosine)) * sample.gas;
    sum.dust += light * sample.dust;
  }
  return sum;
}

}  // namespace

std::optional<Atmosphere> atmosphere_of(const Body& body) {
  if (body.name == "earth" || body.name == "sphere") {
    // Rayleigh coefficients: Bruneton and Neyret (2008). Dust of a clear day. Ozone of 300 Dobson units.
    return Atmosphere{.gas_scatter_per_m = {5.8e-6, 13.5e-6, 33.1e-6},
                      .gas_scale_m = 8000.0,
                      .dust_scatter_per_m = glm::dvec3(3.0e-6),
                      .dust_extinct_per_m = glm::dvec3(3.3e-6),
                      .dust_scale_m = 1200.0,
                      .dust_forwardness = 0.76,
                      .ozone_depth = {0.0098, 0.0282, 0.0013},
                      .ozone_height_m = 25000.0,
                      .top_m = 90000.0,
                      .exposure = 11.0};
  }
  if (body.name == "mars") {
    // Dust of optical depth 0.5, which absorbs blue light and scatters it more sharply forward than red and green.
    return Atmosphere{.gas_scatter_per_m = {0.08e-6, 0.2e-6, 0.5e-6},
                      .gas_scale_m = 11000.0,
                      .dust_scatter_per_m = {40e-6, 31e-6, 20e-6},
                      .dust_extinct_per_m = {42e-6, 40e-6, 39e-6},
                      .dust_scale_m = 11000.0,
                      .dust_forwardness = 0.65,
                      .ozone_depth = glm::dvec3(0.0),
                      .ozone_height_m = 0.0,
                      .top_m = 100000.0,
                      .exposure = 3.0};
  }
  return std::nullopt;
}

SkyTable make_sky_table(const Atmosphere& atmosphere, double planet_radius_m, double eye_radius, double sun_cos) {
  const Air air(atmosphere, planet_radius_m);
  const double radius = std::max(1.0, eye_radius);
  SkyTable table;
  table.outside = radius > air.top();
  table.horizon_dip_rad = table.outside ? 0.0 : std::acos(1.0 / radius);
  const double sun_sin = std::sqrt(std::max(0.0, 1.0 - sun_cos * sun_cos));
  for (int row = 0; row < SkyTable::kRows; ++row) {
    const SkyRay ray = ray_of_row(air, radius, table.outside, table.horizon_dip_rad, row / (SkyTable::kRows - 1.0));
    const RaySamples samples = sample_ray(air, ray, radius);
    for (int column = 0; column < SkyTable::kColumns; ++column) {
      const double azimuth = std::numbers::pi * column / (SkyTable::kColumns - 1.0);
      const glm::dvec3 sun(sun_sin * std::cos(azimuth), sun_sin * std::sin(azimuth), sun_cos);
      const Scattered sum = gather(air, samples, sun);
      table.gas.emplace_back(glm::vec3(sum.gas * air.gas_scatter()), 0.0F);
      table.dust.emplace_back(glm::vec3(sum.dust * air.dust_scatter()), 0.0F);
      table.transmitted.emplace_back(glm::vec3(glm::exp(-samples.depth)), 1.0F);
    }
  }
  return table;
}

double star_visibility(const Atmosphere& air, double eye_height_m, double sun_cos) {
  const auto smooth = [](double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
  };
  constexpr double kDark = -0.242, kBright = -0.07;  // sines of -14° and -4°
  const double thin = std::max(0.0, eye_height_m) / (5.0 * air.gas_scale_m);
  const double day = smooth(kDark, kBright, sun_cos) * std::exp(-thin * thin);
  return (1.0 - day) * (1.0 - day);
}

}  // namespace terrella
