#include "sky/atmosphere.h"

#include <algorithm>
#include <cmath>

namespace terrella {
namespace {

// Rayleigh coefficients and ozone: Bruneton 2017, as fitted to three colours by Hillaire 2020. Dust of a clear day.
Atmosphere earth_air() {
  return {.gas_scatter_per_m = {5.802e-6, 13.558e-6, 33.1e-6},
          .gas_scale_m = 8000.0,
          .dust_scatter_per_m = glm::dvec3(3.0e-6),
          .dust_extinct_per_m = glm::dvec3(3.3e-6),
          .dust_scale_m = 1200.0,
          .dust_forwardness = glm::dvec3(0.76),
          .ozone_absorb_per_m = {0.650e-6, 1.881e-6, 0.085e-6},
          .ozone_height_m = 25000.0,
          .ozone_half_width_m = 15000.0,
          .top_m = 100000.0,
          .exposure = 6.0};
}

// Dust of optical depth 0.45, which absorbs blue light and scatters it more sharply forward than red.
Atmosphere mars_air() {
  return {.gas_scatter_per_m = {0.08e-6, 0.2e-6, 0.5e-6},
          .gas_scale_m = 11000.0,
          .dust_scatter_per_m = {40e-6, 31e-6, 20e-6},
          .dust_extinct_per_m = {42e-6, 40e-6, 39e-6},
          .dust_scale_m = 11000.0,
          .dust_forwardness = {0.63, 0.66, 0.73},
          .ozone_absorb_per_m = glm::dvec3(0.0),
          .ozone_height_m = 0.0,
          .ozone_half_width_m = 1.0,
          .top_m = 110000.0,
          .exposure = 3.0};
}

// Nitrogen of ten times the Earth's column, and haze of optical depth 2 to 5 that absorbs blue (Tomasko et al. 2008).
Atmosphere titan_air() {
  return {.gas_scatter_per_m = {24e-6, 55e-6, 135e-6},
          .gas_scale_m = 20000.0,
          .dust_scatter_per_m = {30e-6, 46e-6, 50e-6},
          .dust_extinct_per_m = {31e-6, 53e-6, 80e-6},
          .dust_scale_m = 65000.0,
          .dust_forwardness = {0.60, 0.62, 0.65},
          .ozone_absorb_per_m = glm::dvec3(0.0),
          .ozone_height_m = 0.0,
          .ozone_half_width_m = 1.0,
          .top_m = 500000.0,
          .exposure = 5.0};
}

// Clouds of sulphuric acid, spread over their height, that absorb blue. Their optical depth is 6 here; it is about 30
// in truth, which shows no ground at all.
Atmosphere venus_air() {
  return {.gas_scatter_per_m = {20e-6, 46e-6, 112e-6},
          .gas_scale_m = 15900.0,
          .dust_scatter_per_m = {299e-6, 294e-6, 270e-6},
          .dust_extinct_per_m = glm::dvec3(300e-6),
          .dust_scale_m = 20000.0,
          .dust_forwardness = glm::dvec3(0.72),
          .ozone_absorb_per_m = glm::dvec3(0.0),
          .ozone_height_m = 0.0,
          .ozone_half_width_m = 1.0,
          .top_m = 250000.0,
          .exposure = 5.0};
}

}  // namespace

std::optional<Atmosphere> atmosphere_of(const Body& body) {
  if (body.name == "earth" || body.name == "sphere") return earth_air();
  if (body.name == "mars") return mars_air();
  if (body.name == "titan") return titan_air();
  if (body.name == "venus") return venus_air();
  return std::nullopt;
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
