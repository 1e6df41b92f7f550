#include "view/number_look.h"

#include <algorithm>
#include <cmath>

namespace terrella {
namespace {

double position_of(const NumberLook& look, double value) {
  if (!look.center) return (value - look.low) / (look.high - look.low);
  const double below = std::max(*look.center - look.low, 0.0), above = std::max(look.high - *look.center, 0.0);
  const double away = value - *look.center;
  // A centre outside the stretch leaves one half of the map, over the whole stretch.
  if (above == 0.0) return 0.5 * (value - look.low) / (look.high - look.low);
  if (below == 0.0) return 0.5 + 0.5 * (value - look.low) / (look.high - look.low);
  return 0.5 + 0.5 * away / (away < 0.0 ? below : above);
}

std::uint8_t premultiplied(std::uint8_t channel, std::uint8_t alpha) {
  return static_cast<std::uint8_t>((channel * alpha + 127) / 255);
}

}  // namespace

Status check_look(const NumberLook& look) {
  if (!std::isfinite(look.low) || !std::isfinite(look.high - look.low) || !(look.low < look.high)) {
    return Error{"a stretch needs two finite values with a finite difference, the lower one first"};
  }
  if (look.center && !std::isfinite(*look.center)) return Error{"the centre of a stretch must be finite"};
  if (!std::isfinite(look.contour_step) || look.contour_step < 0.0) {
    return Error{"the step of contour lines must be finite, and 0 or more"};
  }
  const auto& stops = look.colors.stops;
  if (stops.empty()) return Error{"a colour map needs at least one colour"};
  const auto finite = [](const ColorStop& stop) { return std::isfinite(stop.at); };
  if (!std::ranges::all_of(stops, finite) || !std::ranges::is_sorted(stops, {}, &ColorStop::at)) {
    return Error{"the stops of a colour map must be finite and ascend"};
  }
  return Done{};
}

Rgba8 color_of(const NumberLook& look, double value) {
  const double inside = std::clamp(value, look.low, look.high);
  return color_at(look.colors, look.colors.by_value ? inside : position_of(look, inside));
}

std::vector<std::uint8_t> bake(const NumberLook& look) {
  std::vector<std::uint8_t> texels;
  texels.reserve(4UL * kBakedColors);
  for (int k = 0; k < kBakedColors; ++k) {
    const Rgba8 c = color_of(look, std::lerp(look.low, look.high, (k + 0.5) / kBakedColors));
    texels.insert(texels.end(), {premultiplied(c.r, c.a), premultiplied(c.g, c.a), premultiplied(c.b, c.a), c.a});
  }
  return texels;
}

}  // namespace terrella
