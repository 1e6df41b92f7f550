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
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, 1, ',');
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

struct Unit {
  const char* name;
  double m;  ///< or m²
};
/// A unit for short lengths, and one for those from 1,000 of it.
struct UnitPair {
  Unit small, large;
};

UnitPair length_units(LengthUnits units) {
  constexpr Unit kMetre{" m", 1.0};
  switch (units) {
    case LengthUnits::metric:
      return {kMetre, {" km", 1000.0}};
    case LengthUnits::imperial:
      return {{" ft", 0.3048}, {" mi", 1609.344}};
    case LengthUnits::nautical:
      return {kMetre, {" NM", 1852.0}};
  }
  return {kMetre, kMetre};
}

std::string counted(double length_m, const Unit& unit) {
  return (length_m < 0.0 ? "-" : "") + three_digits(std::abs(length_m) / unit.m) + unit.name;
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

std::string length_text(double length_m, LengthUnits units) {
  const auto [small, large] = length_units(units);
  return counted(length_m, std::abs(length_m) < 999.5 * small.m ? small : large);
}

std::string height_text(double height_m, LengthUnits units) {
  const Unit unit = length_units(units).small;
  const double count = std::round(std::abs(height_m) / unit.m);
  return (height_m < 0.0 && count > 0.0 ? "-" : "") + grouped(count) + unit.name;
}

std::string area_text(double area_m2, LengthUnits units) {
  constexpr double kLeastOfLarge = 0.1;
  const auto [small, large] = length_units(units);
  const Unit& unit = area_m2 < kLeastOfLarge * large.m * large.m ? small : large;
  return three_digits(area_m2 / (unit.m * unit.m)) + unit.name + "²";
}

std::string time_text(UtcTime time) {
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::chrono::system_clock::to_time_t(time)));
}

std::optional<ScaleBar> scale_bar(const View& view, const Ground& ground, double most_px, LengthUnits units) {
  const auto distance_m = centre_distance_m(view, ground);
  if (!distance_m || !(*distance_m > 0.0)) return {};
  const double pixel_m = *distance_m / view.pixels_per_radian();
  const double most_m = most_px * pixel_m;
  const auto [small, large] = length_units(units);
  const Unit& unit = most_m < large.m ? small : large;
  const double power = std::pow(10.0, std::floor(std::log10(most_m / unit.m)));
  const double digit = most_m / (unit.m * power);
  const double length_m = unit.m * power * (digit >= 5.0 ? 5.0 : digit >= 2.0 ? 2.0 : 1.0);
  return ScaleBar{.length_m = length_m, .text = counted(length_m, unit), .width_px = length_m / pixel_m};
}

double pixel_step_deg(const View& view, const Ground& ground) {
  const double height_m = std::max(ground.height_over_m(ground.ellipsoid().to_geodetic(view.eye)), 0.0);
  const double distance_m = std::max(centre_distance_m(view, ground).value_or(height_m), height_m);
  return Angle::radians(distance_m / view.pixels_per_radian() / ground.ellipsoid().a_m()).deg();
}

}  // namespace terrella
