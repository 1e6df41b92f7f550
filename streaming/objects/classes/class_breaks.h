#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace terrella {

/// Ways to put numbers into classes.
enum class ClassKind {
  equal,     ///< classes of the same width, from the least to the greatest value
  quantile,  ///< classes with about as many values each
  jenks      ///< natural breaks: the least sum of squared distances from the means of the classes
};

inline constexpr int kMostClasses = 9;

/// Jenks breaks lie between this many different values at most. With more values, breaks lie between groups of them.
inline constexpr std::size_t kMostJenksCuts = 20'000;

/// Classes of numbers. A class holds the values from its stop up to the next stop, without the next stop.
struct ClassBreaks {
  std::vector<double> stops = {};        ///< least value of each class after the first, ascending
  std::vector<std::size_t> counts = {};  ///< number of values in each class; empty without finite values
  std::size_t left_out = 0;              ///< values that are not finite
};

/// Puts numbers into `classes` classes, 1 to kMostClasses; into fewer if there are fewer different numbers, or if
/// quantiles coincide. Quantiles are those of Hyndman and Fan's type 7, the default of NumPy and R; a stop is the least
/// value that is not under the quantile. Jenks breaks are the optimum, by dynamic programming: Fisher, "On grouping for
/// maximum homogeneity", 1958; Wang and Song, "Ckmeans.1d.dp", 2011. thread: any
[[nodiscard]] ClassBreaks class_breaks(std::span<const double> values, ClassKind kind, int classes);

}  // namespace terrella
