#include "streaming/warp/filter/two_passes.h"

#include <array>

namespace terrella {
namespace {

/// Least side of a square: a smaller one costs more to prepare than it saves.
constexpr int kLeast_px = 8;
/// Least rows of the source in a row of the square. Below that, the filter's rows reach far beyond the square.
constexpr double kLeastRows = 0.5;
/// Most columns by which the filter may lean wrongly from row to row. An error this small does not show.
constexpr double kMostLean = 0.125;
/// Largest error of the curves, source pixels: less than the map's own.
constexpr double kOnCurve_px = 0.005;

/// The column of the canvas where a column of the tile meets a row of the canvas, by Newton's method.
double meeting(const Patch& patch, const Square& square, double x, double row) {
  const double s = patch.s_of(x), v = row - square.shift.y;
  double y = 0.5 * (square.y0 + square.y1);
  for (int step = 0; step < 3; ++step) {
    const double t = patch.t_of(y);
    y += (v - patch.at(s, t).y) / patch.jacobian(s, t).v_y;
  }
  return patch.at(s, patch.t_of(y)).x + square.shift.x;
}

}  // namespace

bool suits_two_passes(const Square& square, double shear) {
  if (square.width() < kLeast_px || square.y1 - square.y0 < kLeast_px) return false;
  const Jacobian& j = square.slopes;
  return std::abs(j.v_y) >= kLeastRows && std::abs(j.u_y / j.v_y - shear) <= kMostLean;
}

std::optional<Patch> column_curves(const Patch& patch, const Square& square, std::int64_t first, std::int64_t end) {
  const auto at = [&](double s, double t) {
    const double x = std::lerp(double(square.x0), double(square.x1), 0.5 * (s + 1.0));
    return CrsPoint{
        meeting(patch, square, x, std::lerp(static_cast<double>(first), static_cast<double>(end), 0.5 * (t + 1.0))),
        0.0};
  };
  std::array<CrsPoint, 9> nodes{};
  for (int k = 0; k < 9; ++k) nodes[static_cast<std::size_t>(k)] = at(k % 3 - 1.0, k / 3 - 1.0);
  const Patch curves = Patch::through(square.x0, static_cast<int>(first), square.x1, static_cast<int>(end), nodes);
  for (int k = 0; k < 4; ++k) {
    const double s = k % 2 - 0.5, t = k / 2 - 0.5;
    if (!(std::abs(curves.at(s, t).x - at(s, t).x) <= kOnCurve_px)) return {};
  }
  return curves;
}

}  // namespace terrella
