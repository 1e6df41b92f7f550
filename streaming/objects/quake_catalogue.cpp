#include "streaming/objects/quake_catalogue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace terrella {
namespace {

using nlohmann::json;

struct DepthColor {
  double depth_km;
  std::array<double, 3> rgb;
};
constexpr std::array<DepthColor, 6> kDepthColors{{{0.0, {255, 80, 50}},
                                                  {35.0, {255, 140, 40}},
                                                  {100.0, {255, 220, 70}},
                                                  {200.0, {110, 215, 100}},
                                                  {350.0, {60, 175, 235}},
                                                  {600.0, {130, 100, 240}}}};

ObjectColor color_at(double depth_km) {
  const auto above = [depth_km](const DepthColor& c) { return c.depth_km > depth_km; };
  const auto* deeper = std::ranges::find_if(kDepthColors, above);
  const DepthColor& b = deeper == kDepthColors.end() ? kDepthColors.back() : *deeper;
  const DepthColor& a = deeper == kDepthColors.begin() ? b : *(deeper - 1);
  const double part = b.depth_km > a.depth_km ? (depth_km - a.depth_km) / (b.depth_km - a.depth_km) : 0.0;
  const auto mixed = [&](std::size_t k) {
    return static_cast<std::uint8_t>(std::lround(std::lerp(a.rgb[k], b.rgb[k], part)));
  };
  return {mixed(0), mixed(1), mixed(2)};
}

const json* member(const json& object, const char* name) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(name);
  return found == object.end() ? nullptr : &*found;
}

double number_or(const json* value, double otherwise) {
  return value != nullptr && value->is_number() ? value->get<double>() : otherwise;
}

double depth_km(const json& feature) {
  const json* geometry = member(feature, "geometry");
  const json* position = geometry == nullptr ? nullptr : member(*geometry, "coordinates");
  if (position == nullptr || !position->is_array() || position->size() < 3) return 0.0;
  return number_or(&(*position)[2], 0.0);
}

}  // namespace

bool is_quake_catalogue(const json& metadata) {
  const json* url = member(metadata, "url");
  return url != nullptr && url->is_string() &&
         url->get_ref<const std::string&>().starts_with("https://earthquake.usgs.gov/");
}

void style_quake(const json& feature, ObjectStyle& style) {
  const json none;
  const json* found = member(feature, "properties");
  const json& properties = found == nullptr ? none : *found;
  constexpr double kRadiusAtZero_m = 4.0e3, kTenfold = 4.0;
  const double magnitude = std::clamp(number_or(member(properties, "mag"), 0.0), -2.0, 10.0);
  if (member(properties, "radius_m") == nullptr) {
    style.point.radius_m = kRadiusAtZero_m * std::pow(10.0, magnitude / kTenfold);
  }
  if (member(properties, "marker-color") == nullptr) style.point.color = color_at(std::max(depth_km(feature), 0.0));
  style.label.text.clear();
}

}  // namespace terrella
