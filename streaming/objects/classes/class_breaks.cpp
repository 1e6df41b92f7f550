#include "streaming/objects/classes/class_breaks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

namespace terrella {
namespace {

/// Different values in ascending order, and how often each occurs.
struct Different {
  std::vector<double> values;
  std::vector<double> counts;
};

Different different(const std::vector<double>& sorted) {
  Different all;
  for (const double value : sorted) {
    if (all.values.empty() || all.values.back() != value) {
      all.values.push_back(value);
      all.counts.push_back(0.0);
    }
    all.counts.back() += 1.0;
  }
  return all;
}

std::vector<double> equal_stops(double least, double greatest, std::size_t classes) {
  std::vector<double> stops;
  stops.reserve(classes);
  double last = least;
  for (std::size_t k = 1; k < classes; ++k) {
    const double stop = std::lerp(least, greatest, static_cast<double>(k) / static_cast<double>(classes));
    if (stop > last) stops.push_back(last = stop);
  }
  return stops;
}

std::vector<double> quantile_stops(const std::vector<double>& sorted, std::size_t classes) {
  std::vector<double> stops;
  stops.reserve(classes);
  double last = sorted.front();
  for (std::size_t k = 1; k < classes; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(classes);
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const double next = sorted[std::min(below + 1, sorted.size() - 1)];
    const double quantile = std::lerp(sorted[below], next, place - std::floor(place));
    const double stop = *std::ranges::lower_bound(sorted, quantile);
    if (stop > last) stops.push_back(last = stop);
  }
  return stops;
}

/// Sums over different values, for the squared distances of a run of them from its mean. The median becomes 0 and the
/// range 1, so that squares neither overflow nor cancel.
class Distances {
 public:
  explicit Distances(const Different& all) {
    const std::size_t count = all.values.size();
    for (auto* sums : {&weight_, &sum_, &square_}) sums->assign(count + 1, 0.0);
    const double middle = all.values[count / 2];
    const double half = 0.5 * all.values.back() - 0.5 * all.values.front();  // the whole range could overflow
    for (std::size_t k = 0; k < count; ++k) {
      const double value = (0.5 * all.values[k] - 0.5 * middle) / half;
      weight_[k + 1] = weight_[k] + all.counts[k];
      sum_[k + 1] = sum_[k] + all.counts[k] * value;
      square_[k + 1] = square_[k] + all.counts[k] * value * value;
    }
  }

  /// The sum for the values [begin, end), which are at least one.
  [[nodiscard]] double of_run(std::size_t begin, std::size_t end) const {
    const double sum = sum_[end] - sum_[begin];
    return std::max(0.0, square_[end] - square_[begin] - sum * sum / (weight_[end] - weight_[begin]));
  }

 private:
  std::vector<double> weight_, sum_, square_;  ///< over the first k values
};

/// The dynamic programme: `best_[j]` is the least sum for the values up to cut j in the classes so far.
class JenksProgramme {
 public:
  JenksProgramme(const Different& all, std::size_t cuts) : distances_(all), cuts_(cuts + 1), best_(cuts + 1) {
    for (std::size_t j = 0; j <= cuts; ++j) cuts_[j] = all.values.size() * j / cuts;
    for (std::size_t j = 1; j <= cuts; ++j) best_[j] = distances_.of_run(0, cuts_[j]);
  }

  void add_class() {
    ++classes_;
    next_.assign(best_.size(), std::numeric_limits<double>::infinity());
    begins_.emplace_back(best_.size(), 0U);
    fill(classes_, best_.size() - 1, classes_ - 1, best_.size() - 2);
    std::swap(best_, next_);
  }

  /// Numbers of the values with which the classes after the first begin.
  [[nodiscard]] std::vector<std::size_t> begins() const {
    std::vector<std::size_t> found(begins_.size());
    std::size_t end = best_.size() - 1;
    for (std::size_t k = begins_.size(); k-- > 0;) {
      end = begins_[k][end];
      found[k] = cuts_[end];
    }
    return found;
  }

 private:
  /// Finds the last class of the ends [first, last]; its begin is in [from, to]. The begin does not fall while the end
  /// rises, so the middle end bounds those of both halves.
  void fill(std::size_t first, std::size_t last, std::size_t from, std::size_t to) {
    if (first > last) return;
    const std::size_t end = first + (last - first) / 2;
    std::size_t begin = from;
    for (std::size_t k = from; k <= std::min(to, end - 1); ++k) {
      const double sum = best_[k] + distances_.of_run(cuts_[k], cuts_[end]);
      if (sum < next_[end]) {
        next_[end] = sum;
        begin = k;
      }
    }
    begins_.back()[end] = static_cast<std::uint32_t>(begin);
    if (end > first) fill(first, end - 1, from, begin);
    fill(end + 1, last, begin, to);
  }

  Distances distances_;
  std::vector<std::size_t> cuts_;  ///< classes end here: numbers of values
  std::vector<double> best_, next_;
  std::vector<std::vector<std::uint32_t>> begins_;  ///< for each class after the first and each end
  std::size_t classes_ = 1;
};

std::vector<double> jenks_stops(const Different& all, std::size_t classes) {
  JenksProgramme programme(all, std::min(all.values.size(), kMostJenksCuts));
  for (std::size_t k = 1; k < classes; ++k) programme.add_class();
  std::vector<double> stops;
  stops.reserve(classes);
  for (const std::size_t begin : programme.begins()) stops.push_back(all.values[begin]);
  return stops;
}

std::vector<std::size_t> counts_of(const std::vector<double>& sorted, const std::vector<double>& stops) {
  std::vector<std::size_t> counts;
  counts.reserve(stops.size() + 1);
  auto begin = sorted.begin();
  for (const double stop : stops) {
    const auto end = std::lower_bound(begin, sorted.end(), stop);
    counts.push_back(static_cast<std::size_t>(end - begin));
    begin = end;
  }
  counts.push_back(static_cast<std::size_t>(sorted.end() - begin));
  return counts;
}

}  // namespace

ClassBreaks class_breaks(std::span<const double> values, ClassKind kind, int classes) {
  std::vector<double> sorted;
  sorted.reserve(values.size());
  std::ranges::copy_if(values, std::back_inserter(sorted), [](double value) { return std::isfinite(value); });
  ClassBreaks breaks{.left_out = values.size() - sorted.size()};
  if (sorted.empty()) return breaks;
  std::ranges::sort(sorted);
  const Different all = different(sorted);
  const std::size_t most = std::min(static_cast<std::size_t>(std::clamp(classes, 1, kMostClasses)), all.values.size());
  if (kind == ClassKind::equal) breaks.stops = equal_stops(sorted.front(), sorted.back(), most);
  if (kind == ClassKind::quantile) breaks.stops = quantile_stops(sorted, most);
  if (kind == ClassKind::jenks && most > 1) breaks.stops = jenks_stops(all, most);
  breaks.counts = counts_of(sorted, breaks.stops);
  return breaks;
}

}  // namespace terrella
