#include "sky/sky_table.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <numbers>

namespace terrella {
namespace {

constexpr int kSkySteps = 32;

AirLight mix(const AirLight& a, const AirLight& b, float t) {
  return {glm::mix(a.gas, b.gas, t), glm::mix(a.dust, b.dust, t), glm::mix(a.more, b.more, t)};
}

}  // namespace

glm::vec3 radiance(const AirLight& light, const Atmosphere& air, double sun_cos) {
  const double c = sun_cos, g_phase = 3.0 / (16.0 * std::numbers::pi) * (1.0 + c * c);
  glm::vec3 dust(0.0F);
  for (int k = 0; k < 3; ++k) {
    const double g = air.dust_forwardness[k], d = 1.0 + g * g - 2.0 * g * c;
    dust[k] = static_cast<float>(3.0 / (8.0 * std::numbers::pi) * (1.0 - g * g) * (1.0 + c * c) /
                                 ((2.0 + g * g) * d * std::sqrt(d)));
  }
  return light.gas * static_cast<float>(g_phase) + light.dust * dust + light.more;
}

AirRay air_ray(const AirTables& air, const AirEye& eye, double sine, double cosine, RayEnd end) {
  AirRay ray{.sine = sine, .cosine = cosine, .eye = eye.radius * cosine};
  const double across2 = squared(eye.radius * sine);
  const double half = std::sqrt(std::max(0.0, squared(air.top()) - across2));
  ray.begin = std::max(ray.eye, -half);
  ray.end = std::max(ray.begin, end == RayEnd::ground ? -std::sqrt(std::max(0.0, 1.0 - across2)) : half);
  return ray;
}

RaySteps ray_steps(const AirTables& air, const AirEye& eye, const AirRay& ray, int count) {
  const double middle = std::clamp(0.0, ray.begin, ray.end);
  const int first = middle <= ray.begin ? 0 : middle >= ray.end ? count : count / 2;
  const auto place = [&](int k) {
    const double s = k < first ? 1.0 - double(k) / first : first == count ? 0.0 : double(k - first) / (count - first);
    return middle + (k < first ? ray.begin - middle : ray.end - middle) * s * s;
  };
  RaySteps out;
  out.steps.reserve(static_cast<std::size_t>(count));
  const double across2 = squared(eye.radius * ray.sine);
  for (int k = 0; k < count; ++k) {
    const double from = place(k), to = place(k + 1), at = 0.5 * (from + to);
    const double r = std::sqrt(across2 + squared(at));
    const AirTables::Density d = air.density(r - 1.0);
    const glm::vec3 passed = out.transmitted * glm::exp(-d.extinct * static_cast<float>(to - from));
    const glm::vec3 seen = (out.transmitted - passed) / glm::max(d.extinct, glm::vec3(1e-12F));
    out.steps.push_back({at, std::max(1.0, r), seen * d.gas, seen * d.dust});
    out.transmitted = passed;
  }
  return out;
}

AirLight march(const AirTables& air, const AirEye& eye, const AirRay& ray, const RaySteps& steps, double azimuth_cos) {
  const double sun_sin = std::sqrt(std::max(0.0, 1.0 - squared(eye.sun_cos)));
  // Cosine between the ray and the Sun, and the Sun's part across the ray, at the point nearest to the centre.
  const double along = ray.sine * sun_sin * azimuth_cos + ray.cosine * eye.sun_cos;
  const double sun_up = eye.radius * (eye.sun_cos - ray.cosine * along);
  AirLight sum;
  for (const RaySteps::Step& step : steps.steps) {
    const double cosine = (sun_up + step.middle * along) / step.radius;
    const glm::vec3 sun = air.sunlight(step.radius, cosine);
    sum.gas += sun * step.gas;
    sum.dust += sun * step.dust;
    sum.more += (step.gas + step.dust) * air.skylight(step.radius, cosine);
  }
  return sum;
}

AirLight SkyTable::at(double azimuth, double row) const {
  const double u = std::clamp(azimuth, 0.0, 1.0) * (kColumns - 1), v = std::clamp(row, 0.0, 1.0) * (kRows - 1);
  const int i = std::min(static_cast<int>(u), kColumns - 2), j = std::min(static_cast<int>(v), kRows - 2);
  const AirLight* p = light.data() + j * kColumns + i;
  const auto a = static_cast<float>(u - i), b = static_cast<float>(v - j);
  return mix(mix(p[0], p[1], a), mix(p[kColumns], p[kColumns + 1], a), b);
}

SkyTable make_sky_table(const AirTables& air, const AirEye& eye) {
  SkyTable table;
  table.outside = eye.radius > air.top();
  table.horizon_dip_rad = table.outside ? 0.0 : std::acos(1.0 / eye.radius);
  for (int row = 0; row < SkyTable::kRows; ++row) {
    const double part = squared(row / (SkyTable::kRows - 1.0));
    double sine = (1.0 + part * (air.top() - 1.0)) / eye.radius, cosine = 0.0;
    if (table.outside) {
      cosine = -std::sqrt(std::max(0.0, 1.0 - sine * sine));
    } else {
      const double elevation = part * (0.5 * std::numbers::pi + table.horizon_dip_rad) - table.horizon_dip_rad;
      sine = std::cos(elevation);
      cosine = std::sin(elevation);
    }
    const AirRay ray = air_ray(air, eye, sine, cosine, RayEnd::air);
    const RaySteps steps = ray_steps(air, eye, ray, kSkySteps);
    table.transmitted.push_back(steps.transmitted);
    for (int column = 0; column < SkyTable::kColumns; ++column) {
      const double azimuth_cos = std::cos(std::numbers::pi * column / (SkyTable::kColumns - 1.0));
      table.light.push_back(march(air, eye, ray, steps, azimuth_cos));
    }
  }
  return table;
}

}  // namespace terrella
