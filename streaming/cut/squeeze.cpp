#include "streaming/cut/squeeze.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "streaming/cut/halve.h"

namespace terrella {
namespace {

using RowBytes = std::vector<std::uint8_t>;

/// Additional pixels on either side of a squeezed tile, for the filter's reach.
constexpr std::int64_t kMargin_px = 4;

/// Copies `row.size() / 4` pixels of a strip's row from column `from` on. Beyond the strip the columns wrap round the
/// planet.
void gather(const Strip& strip, const std::uint8_t* pixels, std::int64_t from, RowBytes& row) {
  const std::int64_t wide = strip.tiles * strip.tile_px;
  const auto count = static_cast<std::int64_t>(row.size() / 4);
  for (std::int64_t i = 0; i < count;) {
    const std::int64_t column = from + i;
    const bool inside = column >= 0 && column < wide;
    const std::int64_t run = inside ? std::min(wide - column, count - i) : 1;
    const std::int64_t at = inside ? column : (column % strip.turn_px + strip.turn_px) % strip.turn_px;
    std::copy_n(pixels + at * 4, run * 4, row.begin() + i * 4);
    i += run;
  }
}

/// Halves a row of pixels (premultiplied floats) with the half-band filter (-1, 9, 9, -1) / 16. Near a pole, neighbours
/// along the parallel differ little, and a plain mean would blur the rest. A wave of five pixels keeps 0.83 of its
/// height with the mean, and 0.96 with this filter. Ends are clamped.
void halve_sharply(const std::vector<float>& in, std::vector<float>& out) {
  const std::size_t last = in.size() / 4 - 1, pairs = in.size() / 8;
  out.resize(pairs * 4);
  const auto mix = [](const float* before, const float* pair, const float* after, float* __restrict to) {
    for (std::size_t c = 0; c < 4; ++c) to[c] = 0.5625F * (pair[c] + pair[4 + c]) - 0.0625F * (before[c] + after[c]);
  };
  const float* pair = in.data();
  float* to = out.data();
  mix(pair, pair, pair + 4 * std::min<std::size_t>(2, last), to);
  for (std::size_t i = 1; i + 1 < pairs; ++i) mix(pair + 8 * i - 4, pair + 8 * i, pair + 8 * i + 8, to + 4 * i);
  const std::size_t end = pairs - 1;
  if (end > 0) mix(pair + 8 * end - 4, pair + 8 * end, pair + 4 * std::min(2 * end + 2, last), to + 4 * end);
}

/// Clamps the overshoot of the filter, and rounds values halfway between two whole numbers to the even one. Such values
/// are common, and rounding all of them up would brighten the row.
void settle(std::vector<float>& row) {
  // A float of this size has no fraction: added and taken away, it rounds to whole numbers, halves to the even one.
  constexpr float kWhole = 3.0F * (1 << 22);
  for (std::size_t i = 0; i < row.size(); i += 4) {
    const float alpha = std::clamp(row[i + 3], 0.0F, 255.0F);
    for (std::size_t c = 0; c < 4; ++c) {
      const float value = std::clamp(row[i + c], 0.0F, alpha), even = (value + kWhole) - kWhole;
      row[i + c] = std::abs(value - even) == 0.5F ? even : value;
    }
  }
}

}  // namespace

std::int64_t squeezed_tiles(const Strip& strip) {
  return strip.squeeze == 0 ? 0 : ((strip.tiles - 1) >> strip.squeeze) + 1;
}

Strip squeezed_tile(const Strip& strip, std::int64_t x) {
  const auto side = static_cast<std::size_t>(strip.tile_px);
  Strip tile{.level = strip.level,
             .tile_y = strip.tile_y,
             .tile_x0 = x,
             .tiles = 1,
             .tile_px = strip.tile_px,
             .rgba = StripPixels(side * side * 4)};
  const std::int64_t from = (x * strip.tile_px - kMargin_px) * (std::int64_t{1} << strip.squeeze);
  RowBytes row(((side + 2 * kMargin_px) << strip.squeeze) * 4);
  std::vector<float> pixels, half;
  for (std::size_t y = 0; y < side; ++y) {
    gather(strip, strip.rgba.data() + y * strip.stride_bytes(), from, row);
    pixels.resize(row.size());
    premultiply(row, pixels.data());
    for (int k = 0; k < strip.squeeze; ++k) {
      halve_sharply(pixels, half);
      pixels.swap(half);
    }
    settle(pixels);
    unpremultiply({pixels.data() + kMargin_px * 4, side * 4}, tile.rgba.data() + y * side * 4);
  }
  return tile;
}

}  // namespace terrella
