#include "view/color_map.h"

#include <algorithm>
#include <cmath>

namespace terrella {

Rgba8 color_at(const ColorMap& map, double at) {
  if (map.stops.empty()) return {};
  const auto after = std::ranges::upper_bound(map.stops, at, {}, &ColorStop::at);
  if (after == map.stops.begin()) return map.stops.front().color;
  const ColorStop& from = *(after - 1);
  if (map.discrete || after == map.stops.end()) return from.color;
  const double part = (at - from.at) / (after->at - from.at);
  const auto mixed = [part](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(std::lerp(static_cast<double>(a), static_cast<double>(b), part)));
  };
  const Rgba8 &a = from.color, &b = after->color;
  return {mixed(a.r, b.r), mixed(a.g, b.g), mixed(a.b, b.b), mixed(a.a, b.a)};
}

}  // namespace terrella
