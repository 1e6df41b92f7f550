#include "streaming/warp/filter/two_passes.h"

#include <array>

namespace terrella {
namespace {

/// Least side of a square: a smaller one costs more to prepare than it saves.
constexpr int kLeast_px = 8;
/// Least columns of the source in a column of the square. Below that, the filter's columns reach far beyond the square.
constexpr double kLeastColumns = 0.1;
/// Most rows by which the filter may lean wrongly from column to column. Up to this the error is not larger than that
/// of one pass (tests/warp).
constexpr double kMostLean = 0.125;
/// Largest error of the curves, source pixels: less than the map's own.
constexpr double kOnCurve_px = 0.001;

/// The row of the canvas where a row of the tile meets a column of the canvas, by Newton's method.
double meeting(const Patch& patch, const Square& square, double column, double y) {
  const double t = patch.t_of(y), u = column - square.shift.x;
  double x = 0.5 * (square.x0 + square.x1);
  for (int step = 0; step < 3; ++step) {
    const double s = patch.s_of(x);
    x += (u - patch.at(s, t).x) / patch.jacobian(s, t).u_x;
  }
  return patch.at(patch.s_of(x), t).y + square.shift.y;
}

}  // namespace

bool suits_two_passes(const Square& square, double shear) {
  if (shear != 0.0 || square.width() < kLeast_px || square.y1 - square.y0 < kLeast_px) return false;
  const Jacobian& j = square.slopes;
  return std::abs(j.u_x) >= kLeastColumns && std::abs(j.v_x) <= kMostLean * std::abs(j.u_x);
}

std::optional<Patch> row_curves(const Patch& patch, const Square& square, std::int64_t first, std::int64_t end) {
  const auto at = [&](double s, double t) {
    const double column = std::lerp(static_cast<double>(first), static_cast<double>(end), 0.5 * (s + 1.0));
    return CrsPoint{0.0,
                    meeting(patch, square, column, std::lerp(double(square.y0), double(square.y1), 0.5 * (t + 1.0)))};
  };
  std::array<CrsPoint, 9> nodes{};
  for (int k = 0; k < 9; ++k) nodes[static_cast<std::size_t>(k)] = at(k % 3 - 1.0, k / 3 - 1.0);
  const Patch curves = Patch::through(static_cast<int>(first), square.y0, static_cast<int>(end), square.y1, nodes);
  for (int k = 0; k < 4; ++k) {
    const double s = k % 2 - 0.5, t = k / 2 - 0.5;
    if (!(std::abs(curves.at(s, t).y - at(s, t).y) <= kOnCurve_px)) return {};
  }
  return curves;
}

}  // namespace terrella
