#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "streaming/warp/filter/taps.h"

namespace terrella {

/// Weights of the pixels around a place, by the fraction of a pixel at which the place lies. The taps are even in
/// number.
class PhaseTable {
 public:
  /// A pixel has 2^bits phases. Half a phase moves a picture by that much.
  PhaseTable(double length, int bits)
      : taps_(2 * static_cast<int>(std::ceil(2.0 * length))), bits_(bits), before_(2.0 * length - 0.5) {
    for (int phase = 0; phase < 1 << bits; ++phase) {
      const std::size_t first = weights_.size();
      double all = 0.0;
      for (int i = 0; i < taps_; ++i) {
        const double at = i - std::ldexp(phase, -bits) - 2.0 * length + 1.0;
        weights_.push_back(static_cast<float>(cubic(at, length)));
        all += weights_.back();
      }
      for (std::size_t k = first; k < weights_.size(); ++k) weights_[k] = static_cast<float>(weights_[k] / all);
    }
  }
  static const PhaseTable& plain() {
    static const PhaseTable table(1.0, 9);
    return table;
  }

  struct Taps {
    std::int64_t first;
    const float* weights;
  };
  /// The taps around a place in `size` pixels. All of them lie inside.
  [[nodiscard]] Taps at(double place, std::int64_t size) const {
    return from(std::clamp(place - before_, 0.0, static_cast<double>(size - taps_)));
  }
  /// The taps from a place on.
  [[nodiscard]] Taps from(double place) const {
    const auto phases = static_cast<std::int64_t>(place * static_cast<double>(1 << bits_) + 0.5);
    return {phases >> bits_, weights_.data() + (phases & ((1 << bits_) - 1)) * taps_};
  }
  [[nodiscard]] int taps() const { return taps_; }

 private:
  int taps_;
  int bits_;
  double before_;  ///< from the first tap's outer edge to the place, at phase 0
  std::vector<float> weights_;
};

}  // namespace terrella
