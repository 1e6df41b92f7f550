#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace terrella {

/// A sample of the values of a raster, summed up. Values without data do not count. All members but `unknown` are 0 if
/// no value is known. thread: any, for all of this header
struct NumberStatistics {
  static constexpr std::size_t kBins = 256;
  static constexpr std::size_t kQuantiles = 1001;

  std::size_t known = 0;    ///< values
  std::size_t unknown = 0;  ///< pixels without data
  double min = 0.0;
  double max = 0.0;
  double mean = 0.0;
  double sigma = 0.0;                          ///< standard deviation of the sample
  std::array<std::uint32_t, kBins> bins{};     ///< number of values in even parts of [min, max]
  std::array<double, kQuantiles> quantiles{};  ///< values in ascending order, at even shares of the sample

  /// Returns the value below which `percent` of the values lie, for 0 to 100; between quantiles linearly.
  [[nodiscard]] double percentile(double percent) const;
};

/// Sums up `numbers`, in any order; NaN and infinite numbers have no data. A value is number · scale + offset.
/// thread: any
[[nodiscard]] NumberStatistics statistics_of(std::vector<float> numbers, double scale = 1.0, double offset = 0.0);

}  // namespace terrella
