#include "tiles/number_texels.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "tiles/height_decoder.h"
#include "tiles/texel_border.h"

namespace terrella {
namespace {

constexpr int kCodes = 65536;

/// Sums over the texels of a mip: numbers that have data, and how many there are. Directions are summed as sines and
/// cosines.
struct NumberSums {
  std::vector<double> sums;
  std::vector<std::uint16_t> known;
  std::vector<double> cosines{};  ///< empty: no directions
  double radian = 0.0;            ///< a radian, in numbers that are directions
  [[nodiscard]] double mean(std::size_t at) const {
    if (cosines.empty()) return sums[at] / known[at];
    const double angle = std::atan2(sums[at], cosines[at]);
    return (angle < 0.0 ? angle + 2.0 * std::numbers::pi : angle) * radian;
  }
};
static_assert(1U << (2 * (kMaxMips - 1)) <= 0xFFFFU);

NumberSums sums_of(const Numbers& numbers, const EncodedTile& tile, double period) {
  NumberSums finest{.sums = {}, .known = {}, .radian = period / (2.0 * std::numbers::pi)};
  finest.sums.reserve(numbers.values.size());
  finest.known.reserve(numbers.values.size());
  for (const float decoded : numbers.values) {
    const double number = decoded * tile.number_scale + tile.number_offset;
    const bool known = std::isfinite(number);
    finest.known.push_back(known ? 1 : 0);
    if (period > 0.0) {
      finest.sums.push_back(known ? std::sin(number / finest.radian) : 0.0);
      finest.cosines.push_back(known ? std::cos(number / finest.radian) : 0.0);
    } else {
      finest.sums.push_back(known ? number : 0.0);
    }
  }
  return finest;
}

NumberSums halve(const NumberSums& from, std::size_t from_side, std::size_t to_side) {
  NumberSums to{std::vector<double>(to_side * to_side), std::vector<std::uint16_t>(to_side * to_side)};
  to.cosines.resize(from.cosines.empty() ? 0 : to.sums.size());
  to.radian = from.radian;
  for (std::size_t row = 0; row < to_side; ++row) {
    for (std::size_t column = 0; column < to_side; ++column) {
      const std::size_t upper = 2 * row * from_side + 2 * column, lower = upper + from_side;
      const std::size_t at = row * to_side + column;
      to.sums[at] = (from.sums[upper] + from.sums[upper + 1]) + (from.sums[lower] + from.sums[lower + 1]);
      if (!from.cosines.empty()) {
        const std::vector<double>& c = from.cosines;
        to.cosines[at] = (c[upper] + c[upper + 1]) + (c[lower] + c[lower + 1]);
      }
      to.known[at] = static_cast<std::uint16_t>(from.known[upper] + from.known[upper + 1] + from.known[lower] +
                                                from.known[lower + 1]);
    }
  }
  return to;
}

/// A mean that falls on the code for "no data" moves by one.
std::uint16_t code_of(const NumberSlots& slots, double number) {
  const double exact = std::round((number - slots.least) * slots.steps);
  const int code = static_cast<int>(std::clamp(exact, 0.0, kCodes - 1.0));
  if (code != slots.none) return static_cast<std::uint16_t>(code);
  return static_cast<std::uint16_t>(code > 0 ? code - 1 : code + 1);
}

template <class Texel, class ToTexel>
std::vector<std::uint8_t> mip_texels(const NumberSums& sums, std::size_t side, std::size_t border, int mip, Texel none,
                                     const ToTexel& to_texel) {
  const int half = (1 << (2 * mip)) / 2;
  return with_border<sizeof(Texel)>(side, border, [&](std::size_t row, std::uint8_t* target) {
    for (std::size_t column = 0; column < side; ++column) {
      const std::size_t at = row * side + column;
      const int known = sums.known[at];
      const Texel texel = known == 0 || known < half ? none : to_texel(sums.mean(at));
      std::memcpy(target + column * sizeof(Texel), &texel, sizeof(Texel));
    }
  });
}

std::vector<std::uint8_t> texels_of(const NumberSums& sums, std::size_t side, std::size_t border, int mip,
                                    const NumberSlots& slots) {
  if (slots.codes) {
    return mip_texels(sums, side, border, mip, static_cast<std::uint16_t>(slots.none),
                      [&](double number) { return code_of(slots, number); });
  }
  return mip_texels(sums, side, border, mip, kNoNumber, [](double number) { return static_cast<float>(number); });
}

}  // namespace

NumberSlots number_slots(const NumberInfo& info) {
  if (!info.whole || info.period > 0.0) return {};
  const double range = static_cast<double>(info.whole->most) - info.whole->least;
  if (range > kCodes - 1) return {};
  NumberSlots slots{.codes = true, .least = static_cast<double>(info.whole->least), .none = kCodes - 1};
  if (range < kCodes - 1) {
    slots.steps = range > 0.0 ? std::floor((kCodes - 2) / range) : 1.0;
    return slots;
  }
  if (!info.nodata || *info.nodata != std::round(*info.nodata)) return {};
  const double none = *info.nodata - slots.least;
  if (none < 0.0 || none > range) return {};
  slots.none = static_cast<int>(none);
  return slots;
}

double number_of(const NumberSlots& slots, double texel) {
  const double none = slots.codes ? slots.none : static_cast<double>(kNoNumber);
  if (texel == none) return std::numeric_limits<double>::quiet_NaN();
  return slots.codes ? slots.least + texel / slots.steps : texel;
}

Result<TileTexels, TileFailure> make_number_texels(const EncodedTile& tile, const NumberInfo& info, int tile_px,
                                                   int gutter, int mips) {
  assert(mips >= 1 && mips <= kMaxMips && gutter >= 0 && tile_px >> (mips - 1) >= 1);
  const auto numbers = decode_numbers(tile, info, tile_px);
  if (!numbers) return numbers.error();
  const NumberSlots slots = number_slots(info);
  const auto side = static_cast<std::size_t>(tile_px);
  NumberSums sums = sums_of(*numbers, tile, info.period);
  TileTexels texels{.tile_px = tile_px, .gutter = gutter, .opaque = true, .mips = {}};
  texels.opaque = std::ranges::all_of(sums.known, [](std::uint16_t known) { return known == 1; });
  for (int mip = 0; mip < mips; ++mip) {
    if (mip > 0) sums = halve(sums, side >> (mip - 1), side >> mip);
    texels.mips.push_back(texels_of(sums, side >> mip, static_cast<std::size_t>(gutter >> mip), mip, slots));
  }
  return texels;
}

}  // namespace terrella
