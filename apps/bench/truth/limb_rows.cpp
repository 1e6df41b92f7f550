#include "apps/bench/truth/limb_rows.h"

#include <algorithm>
#include <cmath>

namespace terrella::truth {
namespace {

constexpr double kDark_levels = 12.0;  // blue beside the globe
constexpr int kBeside_px = 4;

/// The first column of the globe in each row; -1 without a globe in the left half.
std::vector<int> begins_of(const Levels& p, int first, int last) {
  std::vector<int> begins;
  for (int y = first; y < last; ++y) {
    int x = 0;
    while (x < p.width / 2 && p.at(x, y, 2) < kDark_levels) ++x;
    begins.push_back(x < p.width / 2 && x > 0 ? x : -1);
  }
  return begins;
}

LimbRows left_limb(const Levels& p, const std::vector<int>& begins, int first, int channel) {
  LimbRows rows;
  double before = -1.0;
  int peaks = 0, changes = 0;
  for (std::size_t k = 0; k < begins.size(); ++k) {
    double peak = -1.0;
    for (int x = std::max(0, begins[k] - 1); begins[k] >= 0 && x < begins[k] + kBeside_px; ++x)
      peak = std::max(peak, p.at(x, first + static_cast<int>(k), channel));
    if (peak >= 0.0) rows.peak += peak, ++peaks;
    if (peak >= 0.0 && before >= 0.0) rows.change += std::abs(peak - before), ++changes;
    before = peak;
  }
  return {rows.peak / std::max(1, peaks), rows.change / std::max(1, changes)};
}

}  // namespace

Levels reduced(const std::vector<std::uint8_t>& rgba, int width, int height, int times) {
  Levels small{width / times, height / times, {}};
  small.values.reserve(static_cast<std::size_t>(3 * small.width) * static_cast<std::size_t>(small.height));
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      double sum[3] = {};
      for (int k = 0; k < times * times; ++k) {
        const int row = times * y + k / times, column = times * x + k % times;
        const std::size_t px =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += rgba[4 * px + c];
      }
      for (const double s : sum) small.values.push_back(s / (times * times));
    }
  }
  return small;
}

bool LimbPair::peak_agrees() const { return std::abs(drawn.peak - truth.peak) <= 0.05 * truth.peak + 1.0; }

bool LimbPair::change_agrees() const { return std::abs(drawn.change - truth.change) <= 0.10 * truth.change + 0.5; }

LimbPair compare_limbs(const Levels& drawn, const Levels& truth, int first, int last, int channel) {
  const std::vector<int> begins = begins_of(truth, first, last);
  return {left_limb(drawn, begins, first, channel), left_limb(truth, begins, first, channel)};
}

std::array<std::uint8_t, 3> floe_color(double lon_deg, double lat_deg) {
  const double a = std::sin(lon_deg * 0.12) * std::sin(lat_deg * 0.15),
               b = std::sin(lon_deg * 0.5 + lat_deg * 0.1) * std::sin(lat_deg * 0.45);
  if (b > 0.6) return {235, 240, 245};
  if (a > 0.2) return {90, 100, 60};
  return {20, 40, 90};
}

}  // namespace terrella::truth
