#include "streaming/numbers/number_statistics.h"

#include <algorithm>
#include <cmath>

namespace terrella {

double NumberStatistics::percentile(double percent) const {
  const double at = std::clamp(percent, 0.0, 100.0) / 100.0 * static_cast<double>(kQuantiles - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, kQuantiles - 1);
  return std::lerp(quantiles[below], quantiles[above], at - static_cast<double>(below));
}

NumberStatistics statistics_of(std::vector<float> numbers, double scale, double offset) {
  NumberStatistics made;
  const std::size_t all = numbers.size();
  std::erase_if(numbers, [](float number) { return !std::isfinite(number); });
  made.known = numbers.size();
  made.unknown = all - made.known;
  if (numbers.empty()) return made;
  const auto value = [&](float number) { return static_cast<double>(number) * scale + offset; };
  scale < 0.0 ? std::ranges::sort(numbers, std::ranges::greater{}) : std::ranges::sort(numbers);
  made.min = value(numbers.front());
  made.max = value(numbers.back());
  const auto count = static_cast<double>(made.known);
  for (const float number : numbers) made.mean += value(number) / count;
  double squares = 0.0;
  const double bin = (made.max - made.min) / static_cast<double>(NumberStatistics::kBins);
  for (const float number : numbers) {
    const double from_mean = value(number) - made.mean;
    squares += from_mean * from_mean / count;
    const double at = bin > 0.0 ? (value(number) - made.min) / bin : 0.0;
    ++made.bins[std::min(static_cast<std::size_t>(at), NumberStatistics::kBins - 1)];
  }
  made.sigma = std::sqrt(squares);
  for (std::size_t i = 0; i < NumberStatistics::kQuantiles; ++i) {
    const double at = static_cast<double>(i) / static_cast<double>(NumberStatistics::kQuantiles - 1) * (count - 1.0);
    made.quantiles[i] = value(numbers[static_cast<std::size_t>(at + 0.5)]);
  }
  return made;
}

}  // namespace terrella
