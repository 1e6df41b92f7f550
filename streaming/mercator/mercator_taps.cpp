#include "streaming/mercator/mercator_taps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tiles/tile_grid.h"

namespace terrella {
namespace {

/// A smaller weight is not worth a tile: a fifth of one part in 255.
constexpr double kLeastWeight = 1.0 / 1024.0;

double catmull_rom(double distance) {
  const double t = std::abs(distance);
  if (t < 1.0) return (1.5 * t - 2.5) * t * t + 1.0;
  if (t < 2.0) return ((-0.5 * t + 2.5) * t - 4.0) * t + 2.0;
  return 0.0;
}

Taps without_zeros(std::int64_t first, const std::vector<double>& weights) {
  const auto counts = [](double weight) { return std::abs(weight) >= kLeastWeight; };
  const auto begin = std::ranges::find_if(weights, counts);
  auto end = weights.end();
  while (end != begin && !counts(*(end - 1))) --end;
  double sum = 0.0;
  for (auto weight = begin; weight != end; ++weight) sum += *weight;
  Taps taps{first + (begin - weights.begin()), {}};
  for (auto weight = begin; weight != end; ++weight) taps.weights.push_back(static_cast<float>(*weight / sum));
  return taps;
}

Taps taps_over(double centre, double length, std::int64_t least, std::int64_t most) {
  const double scale = std::max(1.0, length);
  const auto begin = static_cast<std::int64_t>(std::floor(centre - 2.0 * scale));
  const auto end = static_cast<std::int64_t>(std::ceil(centre + 2.0 * scale));
  const std::int64_t first = std::clamp(begin, least, most);
  std::vector<double> weights(static_cast<std::size_t>(std::clamp(end - 1, least, most) - first + 1));
  double all = 0.0;
  for (std::int64_t i = begin; i < end; ++i) {
    const double weight = catmull_rom((static_cast<double>(i) + 0.5 - centre) / scale);
    weights[static_cast<std::size_t>(std::clamp(i, least, most) - first)] += weight;
    all += weight;
  }
  for (double& weight : weights) weight /= all;
  return without_zeros(first, weights);
}

}  // namespace

Taps cubic_taps(double centre, double length, std::int64_t count) { return taps_over(centre, length, 0, count - 1); }

std::vector<Taps> column_taps(double first, double texels, int tile_px) {
  constexpr auto kAnywhere = std::numeric_limits<std::int64_t>::max();
  std::vector<Taps> columns(static_cast<std::size_t>(tile_px));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    columns[i] = taps_over(first + (static_cast<double>(i) + 0.5) * texels, 1.0, -kAnywhere, kAnywhere);
  }
  return columns;
}

std::vector<RowTaps> row_taps(double north_deg, double span_deg, int tile_px, double source_rows) {
  const auto source_row = [&](double latitude_deg) {
    return (180.0 - mercator_row_deg(latitude_deg)) / 360.0 * source_rows;
  };
  const double height_deg = span_deg / tile_px;
  std::vector<RowTaps> rows(static_cast<std::size_t>(tile_px));
  for (int j = 0; j < tile_px; ++j) {
    const double north = std::min(north_deg - j * height_deg, kMercatorEndDeg);
    const double south = std::max(north_deg - (j + 1) * height_deg, -kMercatorEndDeg);
    RowTaps& row = rows[static_cast<std::size_t>(j)];
    row.coverage = static_cast<float>(std::clamp((north - south) / height_deg, 0.0, 1.0));
    if (!(north > south)) continue;
    const double first = source_row(north);
    const double last = source_row(south);
    // Mean position over the row (Simpson's rule). In Mercator, the middle of the row lies nearer to the pole.
    const double centre = (first + 4.0 * source_row(0.5 * (north + south)) + last) / 6.0;
    row.taps = cubic_taps(centre, last - first, std::llround(source_rows));
  }
  return rows;
}

}  // namespace terrella
