#include "sky/air_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <numbers>
#include <thread>

namespace terrella {
namespace {

constexpr int kCosines = 256, kHeights = 64;       // size of the table of transmittance
constexpr int kSunCosines = 32, kSkyHeights = 32;  // size of the table of skylight
constexpr int kDepthSteps = 40, kRaySteps = 24;
constexpr int kZeniths = 8, kAzimuths = 4;  // directions from which skylight is gathered; azimuths of half a turn
// Angular radius of the Sun, over which a sunset is spread.
constexpr double kSunSize_rad = 0.00465;

/// Interpolates a table whose first and last texels are at 0 and 1.
glm::vec3 at(const std::vector<glm::vec3>& table, int columns, int rows, double x, double y) {
  const double u = std::clamp(x, 0.0, 1.0) * (columns - 1), v = std::clamp(y, 0.0, 1.0) * (rows - 1);
  const int i = std::min(static_cast<int>(u), columns - 2), j = std::min(static_cast<int>(v), rows - 2);
  const auto a = static_cast<float>(u - i), b = static_cast<float>(v - j);
  const glm::vec3* p = table.data() + j * columns + i;
  return (1.0F - b) * ((1.0F - a) * p[0] + a * p[1]) + b * ((1.0F - a) * p[columns] + a * p[columns + 1]);
}

// The Sun's cosine by columns that are closest at the horizon.
double column_of_sun(double cosine) { return 0.5 + 0.5 * std::copysign(std::sqrt(std::abs(cosine)), cosine); }
double sun_of_column(double x) { return (2.0 * x - 1.0) * std::abs(2.0 * x - 1.0); }

/// Calls a function for 0...count-1 on two threads.
template <class Each>
void in_two(int count, Each each) {
  std::thread other([&] {
    for (int k = 1; k < count; k += 2) each(k);
  });
  for (int k = 0; k < count; k += 2) each(k);
  other.join();
}

}  // namespace

AirTables::AirTables(const Atmosphere& air, double planet_radius_m)
    : air_(air),
      radius_m_(planet_radius_m),
      top_(1.0 + air.top_m / planet_radius_m),
      farthest_(std::sqrt(squared(top_) - 1.0)),
      gas_(air.gas_scatter_per_m * planet_radius_m),
      dust_(air.dust_scatter_per_m * planet_radius_m),
      dust_extinct_(air.dust_extinct_per_m * planet_radius_m),
      ozone_(air.ozone_absorb_per_m * planet_radius_m),
      gas_scale_m_(static_cast<float>(air.gas_scale_m)),
      dust_scale_m_(static_cast<float>(air.dust_scale_m)),
      ozone_height_m_(static_cast<float>(air.ozone_height_m)),
      ozone_half_width_m_(static_cast<float>(air.ozone_half_width_m)) {
  make_transmittance();
  make_skylight();
}

AirTables::Density AirTables::density(double height) const {
  const auto h_m = static_cast<float>(std::max(0.0, height) * radius_m_);
  const float gas = std::exp(-h_m / gas_scale_m_), dust = std::exp(-h_m / dust_scale_m_);
  const float ozone = std::max(0.0F, 1.0F - std::abs(h_m - ozone_height_m_) / ozone_half_width_m_);
  const glm::vec3 gas_scattered = gas * gas_;
  return {gas_scattered, dust * dust_, gas_scattered + dust * dust_extinct_ + ozone * ozone_};
}

// Steps are shortest where the air is densest: at the lowest point of the ray.
glm::vec3 AirTables::integrate_transmittance(double radius, double cosine) const {
  const double low = -radius * cosine, across2 = squared(radius) - squared(low);
  const double end = std::sqrt(std::max(0.0, squared(top_) - across2));
  const double from = -low;  // coordinates along the ray from its lowest point
  glm::dvec3 depth(0.0);
  const auto add = [&](double a, double b) {
    for (int k = 0; k < kDepthSteps; ++k) {
      const double p = a + (b - a) * squared(double(k) / kDepthSteps),
                   q = a + (b - a) * squared((k + 1.0) / kDepthSteps);
      const double middle = 0.5 * (p + q);
      depth += glm::dvec3(density(std::sqrt(across2 + squared(middle)) - 1.0).extinct) * std::abs(q - p);
    }
  };
  if (from < 0.0) add(0.0, from);
  add(std::max(0.0, from), end);
  return glm::vec3(glm::exp(-depth));
}

// Rows are distances to the horizon, columns are distances to the end of the air (Bruneton 2017).
void AirTables::make_transmittance() {
  transmittance_.resize(static_cast<std::size_t>(kCosines) * kHeights);
  in_two(kHeights, [&](int j) {
    const double to_horizon = farthest_ * j / (kHeights - 1.0);
    const double radius = std::sqrt(1.0 + squared(to_horizon)), least = top_ - radius;
    for (int i = 0; i < kCosines; ++i) {
      const double d = least + (to_horizon + farthest_ - least) * i / (kCosines - 1.0);
      const double cosine = d > 0.0 ? (squared(top_) - squared(radius) - squared(d)) / (2.0 * radius * d) : 1.0;
      transmittance_[static_cast<std::size_t>(j * kCosines + i)] =
          integrate_transmittance(radius, std::clamp(cosine, -1.0, 1.0));
    }
  });
}

glm::vec3 AirTables::transmittance(double radius, double cosine) const {
  const double r = std::clamp(radius, 1.0, top_);
  const double to_horizon = std::sqrt(squared(r) - 1.0);
  const double end = -r * cosine + std::sqrt(std::max(0.0, squared(r) * (squared(cosine) - 1.0) + squared(top_)));
  const double least = top_ - r;
  return at(transmittance_, kCosines, kHeights, (end - least) / (to_horizon + farthest_ - least),
            to_horizon / farthest_);
}

glm::vec3 AirTables::sunlight(double radius, double cosine) const {
  // The horizon's cosine to the zenith. A ray to a Sun that is partly under it passes over the ground.
  const double sine = 1.0 / std::max(1.0, radius), least = -std::sqrt(1.0 - squared(sine));
  // Height of the Sun's middle over the horizon, in radii of its disc.
  const double over = (cosine - least) / (sine * kSunSize_rad);
  if (over <= -1.0) return glm::vec3(0.0F);
  double shown = 1.0;
  if (over < 1.0) shown = 0.5 + (over * std::sqrt(1.0 - over * over) + std::asin(over)) / std::numbers::pi;
  return static_cast<float>(shown) * transmittance(radius, std::max(cosine, least));
}

glm::vec3 AirTables::skylight(double radius, double cosine) const {
  return at(skylight_, kSunCosines, kSkyHeights, column_of_sun(cosine),
            std::sqrt(std::max(0.0, (radius - 1.0) / (top_ - 1.0))));
}

/// A piece of a ray from a point at which skylight is gathered.
struct AirTables::RayStep {
  double along, radius;
  glm::vec3 scattered;  ///< part of the light there that is scattered to the point
  glm::vec3 reflected;  ///< part that the ground throws to the point, from the last step of a ray that meets it
};

std::vector<AirTables::RayStep> AirTables::walk(double radius, double cosine) const {
  const double lowest = -radius * cosine, across2 = squared(radius) - squared(lowest);
  const bool ground = cosine < 0.0 && across2 < 1.0;
  const double end = ground ? lowest - std::sqrt(1.0 - across2) : lowest + std::sqrt(squared(top_) - across2);
  std::vector<RayStep> steps;
  glm::vec3 through(1.0F);
  for (int k = 0; k < kRaySteps; ++k) {
    const double a = end * squared(double(k) / kRaySteps), b = end * squared((k + 1.0) / kRaySteps);
    const double along = 0.5 * (a + b);
    const double r = std::sqrt(across2 + squared(along - lowest));
    const Density d = density(r - 1.0);
    const auto length = static_cast<float>(b - a);
    const glm::vec3 passed = glm::exp(-d.extinct * length);
    const glm::vec3 part = through * (1.0F - passed) / glm::max(d.extinct, glm::vec3(1e-9F));
    steps.push_back({along, r, part * (d.gas + d.dust), glm::vec3(0.0F)});
    through *= passed;
  }
  if (ground) steps.push_back({end, 1.0, glm::vec3(0.0F), through * static_cast<float>(kGroundAlbedo)});
  return steps;
}

// Hillaire 2020, equations 5 to 10: the light of the second order, and the part of light that is scattered once more,
// both by a phase function that is equal to all sides. Light of all orders is then a geometric series.
void AirTables::make_skylight_row(int row) {
  const double radius = 1.0 + (top_ - 1.0) * std::max(1e-6, squared(row / (kSkyHeights - 1.0)));
  std::array<std::vector<RayStep>, kZeniths> rays;
  glm::vec3 again(0.0F);
  for (int z = 0; z < kZeniths; ++z) {
    auto& ray = rays[static_cast<std::size_t>(z)];
    ray = walk(std::min(radius, top_ - 1e-9), 1.0 - (2.0 * z + 1.0) / kZeniths);
    for (const RayStep& step : ray) again += step.scattered / float(kZeniths);
  }
  for (int column = 0; column < kSunCosines; ++column) {
    const double sun_z = sun_of_column(column / (kSunCosines - 1.0)), sun_x = std::sqrt(1.0 - squared(sun_z));
    glm::vec3 second(0.0F);
    for (int z = 0; z < kZeniths; ++z) {
      const double up = 1.0 - (2.0 * z + 1.0) / kZeniths, side = std::sqrt(1.0 - squared(up));
      for (int a = 0; a < kAzimuths; ++a) {
        const double to_sun = up * sun_z + side * sun_x * std::cos(std::numbers::pi * (a + 0.5) / kAzimuths);
        for (const RayStep& step : rays[static_cast<std::size_t>(z)]) {
          const double cosine = (radius * sun_z + step.along * to_sun) / step.radius;
          glm::vec3 part = step.scattered * static_cast<float>(0.25 / std::numbers::pi);
          part += step.reflected * static_cast<float>(std::max(0.0, cosine) / std::numbers::pi);
          second += part * sunlight(step.radius, cosine) / float(kZeniths * kAzimuths);
        }
      }
    }
    skylight_[static_cast<std::size_t>(row * kSunCosines + column)] = second / (1.0F - glm::min(again, 0.99F));
  }
}

void AirTables::make_skylight() {
  skylight_.resize(static_cast<std::size_t>(kSunCosines) * kSkyHeights);
  in_two(kSkyHeights, [&](int row) { make_skylight_row(row); });
}

}  // namespace terrella
