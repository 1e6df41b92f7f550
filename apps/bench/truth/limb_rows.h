#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace terrella::truth {

/// A picture as levels, 0...255, in double. thread: any, for all of this header
struct Levels {
  int width = 0, height = 0;
  std::vector<double> values;  ///< three a pixel, rows from the top
  [[nodiscard]] double at(int x, int y, int c) const {
    const int index = 3 * (y * width + x) + c;
    return values[static_cast<std::size_t>(index)];
  }
};

/// Means over squares of `times` by `times` pixels of RGBA8, rows from the top.
[[nodiscard]] Levels reduced(const std::vector<std::uint8_t>& rgba, int width, int height, int times);

/// The left limb, by row: the brightest of the pixels beside it, and its change from row to row, both as means.
struct LimbRows {
  double peak = 0.0, change = 0.0;
};

/// The limb of a picture, and of the same picture drawn larger, in one channel.
struct LimbPair {
  LimbRows drawn, truth;
  /// 5 % of the peak, and a level.
  [[nodiscard]] bool peak_agrees() const;
  /// 10 % of the change, and half a level of rounding in each of two rows.
  [[nodiscard]] bool change_agrees() const;
};

/// Measures the rows from `first` up to `last` that have a limb in their left half. Both pictures are equally large.
[[nodiscard]] LimbPair compare_limbs(const Levels& drawn, const Levels& truth, int first, int last, int channel);

/// Land, sea, and white floes of six degrees in a blue sea: the colour of a place.
[[nodiscard]] std::array<std::uint8_t, 3> floe_color(double lon_deg, double lat_deg);

}  // namespace terrella::truth
