#include "apps/bench/truth/masked_error.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace terrella::truth {
namespace {

constexpr double kClear_deg = 81.0;
constexpr double kBand_deg = 81.0;
constexpr double kMid_deg = 60.0;
constexpr double kCore_px = 40.0;

Mask mask_of_latitudes(const TruthImage& truth, double from_deg, double to_deg) {
  Mask mask{truth.width, truth.height, std::vector<std::uint8_t>(truth.hits.size())};
  for (std::size_t i = 0; i < truth.hits.size(); ++i) {
    const double lat_deg = std::abs(static_cast<double>(truth.lat_deg[i]));
    mask.set[i] = truth.covered(i) && lat_deg >= from_deg && lat_deg < to_deg &&
                  static_cast<double>(truth.incidence_deg[i]) < kClear_deg;
  }
  return mask;
}

/// True if the pixel and its four neighbours are in the picture and set.
bool is_inside(const Mask& mask, int x, int y) {
  const auto set = [&](int column, int row) {
    return column >= 0 && row >= 0 && column < mask.width && row < mask.height &&
           mask.set[static_cast<std::size_t>(row) * static_cast<std::size_t>(mask.width) +
                    static_cast<std::size_t>(column)] != 0;
  };
  return set(x, y) && set(x - 1, y) && set(x + 1, y) && set(x, y - 1) && set(x, y + 1);
}

}  // namespace

Mask pole_band_mask(const TruthImage& truth) { return mask_of_latitudes(truth, kBand_deg, 91.0); }
Mask mid_latitude_mask(const TruthImage& truth) { return mask_of_latitudes(truth, 0.0, kMid_deg); }
Mask clear_mask(const TruthImage& truth) { return mask_of_latitudes(truth, 0.0, 91.0); }

Mask pole_core_mask(const TruthImage& truth) {
  Mask mask = clear_mask(truth);
  std::size_t nearest = 0;
  double most_deg = -1.0;
  for (std::size_t i = 0; i < mask.set.size(); ++i) {
    const double lat_deg = std::abs(static_cast<double>(truth.lat_deg[i]));
    if (mask.set[i] == 0 || lat_deg <= most_deg) continue;
    nearest = i;
    most_deg = lat_deg;
  }
  const int pole_x = static_cast<int>(nearest) % truth.width, pole_y = static_cast<int>(nearest) / truth.width;
  // Latitude has no maximum but a pole: a greatest latitude beside the edge or the limb belongs to a pole out of sight.
  const bool in_sight = is_inside(mask, pole_x, pole_y);
  for (std::size_t i = 0; i < mask.set.size(); ++i) {
    const int x = static_cast<int>(i) % truth.width, y = static_cast<int>(i) / truth.width;
    if (!in_sight || std::hypot(x - pole_x, y - pole_y) > kCore_px) mask.set[i] = 0;
  }
  return mask;
}

ZoneError masked_error(const Picture& shot, const TruthImage& truth, const Mask& mask) {
  assert(shot.width == truth.width && shot.height == truth.height && mask.set.size() == truth.hits.size());
  ZoneError error;
  double squares = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < mask.set.size(); ++i) {
    if (mask.set[i] == 0 || !truth.covered(i)) continue;
    ++error.pixels;
    for (std::size_t c = 3 * i; c < 3 * i + 3; ++c) {
      const double off = static_cast<double>(shot.rgb[c]) - static_cast<double>(truth.rgb[c]);
      squares += off * off;
      sum += off;
      error.max = std::max(error.max, std::abs(off));
    }
  }
  if (error.pixels == 0) return error;
  const double levels = 3.0 * static_cast<double>(error.pixels);
  error.rms = std::sqrt(squares / levels);
  error.bias = sum / levels;
  return error;
}

}  // namespace terrella::truth
