#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "streaming/numbers/stretch_rule.h"

namespace terrella {

/// Three bands that are shown as red, green and blue, counted from 0.
struct BandComposite {
  std::array<std::size_t, 3> bands{0, 1, 2};
  /// None: 8 bits as they are, other samples from the 2nd to the 98th percentile of each band.
  std::array<std::optional<StretchRule>, 3> stretch{};
};

/// Choices that replace those of the file.
struct CodingOptions {
  std::optional<double> nodata = {};
  std::optional<double> scale = {};
  std::optional<double> offset = {};
  std::optional<std::size_t> band = {};  ///< band of numbers, counted from 0; none: the only one
  std::optional<BandComposite> composite = {};
};

}  // namespace terrella
