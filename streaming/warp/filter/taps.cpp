#include "streaming/warp/filter/taps.h"

#include <algorithm>
#include <cmath>

namespace terrella {
namespace {

/// A smaller weight is not worth a block: a fifth of one part in 255.
constexpr double kLeastWeight = 1.0 / 1024.0;
/// Up to this length the cubic is not stretched. Some waves beyond the tile's limit pass; the rest stays sharper.
constexpr double kPlainLength = 1.3;
/// A length up to this is one pixel, for a filter of four pixels.
constexpr double kRounded = 1.05;
/// The least width of the ellipse, source pixels. Below a pixel the cubic itself keeps the width; the ellipse then only
/// says how it leans. Leaning more would skip pixels between rows.
constexpr double kLeastWidth = 0.5;
/// The largest filter, source pixels a side: 4 · 12. It is needed only in tiles of which a part is far smaller.
constexpr double kMostLength = 12.0;

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

/// The part of a line at which it crosses a value, [0, 1]. The line is a parabola through its three values.
double crossing(const Line& line, double value) {
  const double bend = 2.0 * (line.before + line.after) - 4.0 * line.middle;
  const double slope = line.after - line.before - bend;
  double t = (value - line.before) / (line.after - line.before);
  for (int step = 0; step < 3; ++step) {
    const double by_t = slope + 2.0 * bend * t;
    if (by_t == 0.0) break;
    t -= (line.before + (slope + bend * t) * t - value) / by_t;
  }
  return std::clamp(t, 0.0, 1.0);
}

/// The fraction of a unit square on the positive side of a line. The middle is `distance` from it; `by_x` and `by_y`
/// are the slopes of the distance.
double positive_side(double distance, double by_x, double by_y) {
  const double wide = 0.5 * std::max(std::abs(by_x), std::abs(by_y));
  const double narrow = 0.5 * std::min(std::abs(by_x), std::abs(by_y));
  if (distance >= wide + narrow) return 1.0;
  if (distance <= -wide - narrow) return 0.0;
  if (narrow < 1e-9 * wide) return 0.5 + 0.5 * distance / wide;
  const auto square = [](double x) { return x > 0.0 ? x * x : 0.0; };
  return (square(distance + wide + narrow) - square(distance + wide - narrow) - square(distance - wide + narrow) +
          square(distance - wide - narrow)) /
         (8.0 * wide * narrow);
}

}  // namespace

double cubic(double distance, double length) {
  const double t = std::abs(distance) / length;
  const double b = 0.25 - 0.25 / (length * length), c = 0.5 - 0.5 * b;
  if (t < 1.0) return ((2.0 - 1.5 * b - c) * t - 3.0 + 2.0 * b + c) * t * t + 1.0 - b / 3.0;
  if (t < 2.0) return (((-b / 6.0 - c) * t + b + 5.0 * c) * t - 2.0 * b - 8.0 * c) * t + 4.0 / 3.0 * b + 4.0 * c;
  return 0.0;
}

Taps cubic_taps(double centre, double length) {
  const double scale = std::max(1.0, length);
  const auto first = static_cast<std::int64_t>(std::floor(centre - 2.0 * scale));
  const auto end = static_cast<std::int64_t>(std::ceil(centre + 2.0 * scale));
  std::vector<double> weights(static_cast<std::size_t>(end - first));
  double all = 0.0;
  for (std::int64_t i = first; i < end; ++i) {
    const double weight = cubic(static_cast<double>(i) + 0.5 - centre, scale);
    weights[static_cast<std::size_t>(i - first)] = weight;
    all += weight;
  }
  for (double& weight : weights) weight /= all;
  return without_zeros(first, weights);
}

LineTaps line_taps(const Line& given, double size) {
  const Line line = given.after < given.before ? Line{given.after, given.middle, given.before} : given;
  LineTaps made;
  const double from = size > 0.0 && line.before < 0.0 ? crossing(line, 0.0) : 0.0;
  const double to = size > 0.0 && line.after > size ? crossing(line, size) : 1.0;
  if (size > 0.0 && (line.after <= 0.0 || line.before >= size)) return made;
  made.coverage = static_cast<float>(std::max(to - from, 0.0));
  // Mean position over the line (Simpson's rule).
  double centre = (line.before + 4.0 * line.middle + line.after) / 6.0;
  if (to - from < 1.0) centre = 0.5 * (std::max(line.before, 0.0) + std::min(line.after, size));
  made.taps = cubic_taps(centre, line.after - line.before);
  return made;
}

KernelShape kernel_shape(const Jacobian& j) {
  const double uu = j.u_x * j.u_x + j.u_y * j.u_y, vv = j.v_x * j.v_x + j.v_y * j.v_y;
  const double uv = j.u_x * j.v_x + j.u_y * j.v_y;
  const double mean = 0.5 * (uu + vv), apart = std::hypot(0.5 * (uu - vv), uv);
  const double longest = mean + apart, shortest = mean - apart;
  if (!(longest > kPlainLength * kPlainLength)) return {};
  const double most = kMostLength * kMostLength;
  const double length = std::clamp(longest, 1.0, most);
  const double width = std::clamp(shortest, kLeastWidth * kLeastWidth, most);
  const double part = apart > 1e-12 * mean ? (length - width) / (2.0 * apart) : 0.0;
  const double ellipse_uu = width + part * (uu - shortest), ellipse_vv = width + part * (vv - shortest);
  const double shear = part * uv / ellipse_vv;
  const auto at_least_one = [](double square) { return square < kRounded * kRounded ? 1.0 : std::sqrt(square); };
  return {
      .length_u = at_least_one(ellipse_uu - shear * part * uv), .length_v = at_least_one(ellipse_vv), .shear = shear};
}

double covered(double at, double size, double by_x, double by_y) {
  return std::max(0.0, positive_side(at, by_x, by_y) + positive_side(size - at, by_x, by_y) - 1.0);
}

}  // namespace terrella
