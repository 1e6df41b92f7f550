#include "apps/bench/truth/masked_error.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace terrella::truth {
namespace {

constexpr double kClear_deg = 81.0;
constexpr double kBand_deg = 81.0;
constexpr double kMid_deg = 60.0;

Mask mask_of_latitudes(const TruthImage& truth, double from_deg, double to_deg) {
  Mask mask{truth.width, truth.height, std::vector<std::uint8_t>(truth.hits.size())};
  for (std::size_t i = 0; i < truth.hits.size(); ++i) {
    const double lat_deg = std::abs(static_cast<double>(truth.lat_deg[i]));
    mask.set[i] = truth.covered(i) && lat_deg >= from_deg && lat_deg < to_deg &&
                  static_cast<double>(truth.incidence_deg[i]) < kClear_deg;
  }
  return mask;
}

}  // namespace

Mask pole_band_mask(const TruthImage& truth) { return mask_of_latitudes(truth, kBand_deg, 91.0); }
Mask mid_latitude_mask(const TruthImage& truth) { return mask_of_latitudes(truth, 0.0, kMid_deg); }
Mask clear_mask(const TruthImage& truth) { return mask_of_latitudes(truth, 0.0, 91.0); }

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
