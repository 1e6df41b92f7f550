#pragma once

#include <cstddef>
#include <vector>

// thread: any, for all of this header
namespace terrella {

/// Index of the section between two knots that holds `at`: 0 to knots - 2; 0 for a single knot. Times ascend.
[[nodiscard]] std::size_t section_at(const std::vector<double>& times, double at);

/// A smooth curve through values at ascending times. Its speed has no jumps, and between two values it never leaves
/// their range: cubic Hermite pieces with the slopes of Fritsch and Butland (1984, doi:10.1137/0905021). Two values are
/// joined by a straight line. Before the first and after the last time the value stays.
class MonotoneCurve {
 public:
  MonotoneCurve() = default;
  /// As many times as values, one at least.
  MonotoneCurve(const std::vector<double>& times, std::vector<double> values);
  [[nodiscard]] double at(double time) const;

 private:
  std::vector<double> times_, values_, slopes_;
};

}  // namespace terrella
