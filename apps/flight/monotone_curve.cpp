#include "apps/flight/monotone_curve.h"

#include <algorithm>
#include <utility>

namespace terrella {
namespace {

/// Slope at a knot between two straight lines, from the lengths and slopes of both.
double slope_between(double before_s, double slope_before, double after_s, double slope_after) {
  if (slope_before * slope_after <= 0.0) return 0.0;
  const double weight_before = 2.0 * after_s + before_s, weight_after = after_s + 2.0 * before_s;
  return (weight_before + weight_after) / (weight_before / slope_before + weight_after / slope_after);
}

}  // namespace

std::size_t section_at(const std::vector<double>& times, double at) {
  if (times.size() < 2) return 0;
  const auto next = std::upper_bound(times.begin() + 1, times.end() - 1, at);
  return static_cast<std::size_t>(next - times.begin()) - 1;
}

MonotoneCurve::MonotoneCurve(const std::vector<double>& times, std::vector<double> values)
    : times_(times), values_(std::move(values)), slopes_(times.size(), 0.0) {
  const std::size_t last = times_.size() - 1;
  const auto length = [this](std::size_t i) { return times_[i + 1] - times_[i]; };
  const auto line = [&](std::size_t i) { return (values_[i + 1] - values_[i]) / length(i); };
  if (last == 0) return;
  slopes_.front() = line(0);
  slopes_.back() = line(last - 1);
  for (std::size_t i = 1; i < last; ++i) slopes_[i] = slope_between(length(i - 1), line(i - 1), length(i), line(i));
}

double MonotoneCurve::at(double time) const {
  if (time <= times_.front()) return values_.front();
  if (time >= times_.back()) return values_.back();
  const std::size_t i = section_at(times_, time);
  const double length = times_[i + 1] - times_[i], u = (time - times_[i]) / length;
  const double rise = values_[i + 1] - values_[i];
  const double a = slopes_[i] * length, b = slopes_[i + 1] * length;
  return values_[i] + u * (a + u * (3.0 * rise - 2.0 * a - b + u * (a + b - 2.0 * rise)));
}

}  // namespace terrella
