#include "apps/viewer/panels/readout.h"

#include <fmt/chrono.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "view/surface_pin.h"

namespace terrella {
namespace {

/// Formats a whole number with thousands separators.
std::string grouped(double value) {
  std::string digits = fmt::format("{:.0f}", value);
  for (int at = static_cast<int>(digits.size()) - 3; at > 0; at -= 3) digits.insert(static_cast<std::size_t>(at), ",");
  return digits;
}

std::string three_digits(double value) {
  if (value >= 100.0) return grouped(value);
  const int decimals = value >= 10.0 ? 1 : 2;
  std::string text = fmt::format("{:.{}f}", value, decimals);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string angle_text(Angle angle, int decimals, const char* positive, const char* negative) {
  return fmt::format("{:.{}f}° {}", std::abs(angle.deg()), decimals, angle < Angle{} ? negative : positive);
}

/// Distance from the eye to the ground at the picture's centre.
std::optional<double> centre_distance_m(const View& view, const Ground& ground) {
  const Grab centre = grab(view, ground, {0.5 * view.viewport.width_px, 0.5 * view.viewport.height_px});
  if (!centre.on_surface) return {};
  return glm::distance(centre.point.xyz_m, view.eye.xyz_m);
}

}  // namespace

std::string place_text(const Geodetic& place, double step_deg) {
  const double digits = step_deg > 0.0 ? std::ceil(-std::log10(step_deg)) : 0.0;
  const int decimals = static_cast<int>(std::clamp(digits, 0.0, 7.0));
  return angle_text(place.lat, decimals, "N", "S") + "   " + angle_text(place.lon, decimals, "E", "W");
}

std::string length_text(double length_m) {
  if (std::abs(length_m) < 999.5) return (length_m < 0.0 ? "-" : "") + three_digits(std::abs(length_m)) + " m";
  return (length_m < 0.0 ? "-" : "") + three_digits(std::abs(length_m) * 1e-3) + " km";
}

std::string area_text(double area_m2) {
  constexpr double kSquareKilometre_m2 = 1.0e6, kLeastInKilometres = 0.1;
  const double km2 = area_m2 / kSquareKilometre_m2;
  return km2 < kLeastInKilometres ? three_digits(area_m2) + " m²" : three_digits(km2) + " km²";
}

std::string time_text(UtcTime time) {
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::chrono::system_clock::to_time_t(time)));
}

std::optional<ScaleBar> scale_bar(const View& view, const Ground& ground, double most_px) {
  const auto distance_m = centre_distance_m(view, ground);
  if (!distance_m || !(*distance_m > 0.0)) return {};
  const double pixel_m = *distance_m / view.pixels_per_radian();
  const double most_m = most_px * pixel_m;
  const double power = std::pow(10.0, std::floor(std::log10(most_m)));
  const double digit = most_m / power;
  const double length_m = power * (digit >= 5.0 ? 5.0 : digit >= 2.0 ? 2.0 : 1.0);
  return ScaleBar{length_m, length_m / pixel_m};
}

double pixel_step_deg(const View& view, const Ground& ground) {
  const double height_m = std::max(ground.height_over_m(ground.ellipsoid().to_geodetic(view.eye)), 0.0);
  const double distance_m = std::max(centre_distance_m(view, ground).value_or(height_m), height_m);
  return Angle::radians(distance_m / view.pixels_per_radian() / ground.ellipsoid().a_m()).deg();
}

}  // namespace terrella
