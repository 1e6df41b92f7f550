#include "streaming/warp/map/patch.h"

namespace terrella {
namespace {

/// Coefficients of the parabola through the values at -1, 0 and 1.
std::array<double, 3> parabola(double before, double middle, double after) {
  return {middle, 0.5 * (after - before), 0.5 * (after + before) - middle};
}

std::array<double, 9> coefficients(const std::array<double, 9>& nodes) {
  std::array<double, 9> rows{}, both{};
  for (std::size_t j = 0; j < 3; ++j) {
    const auto row = parabola(nodes[3 * j], nodes[3 * j + 1], nodes[3 * j + 2]);
    std::ranges::copy(row, rows.begin() + static_cast<std::ptrdiff_t>(3 * j));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const auto column = parabola(rows[i], rows[3 + i], rows[6 + i]);
    for (std::size_t j = 0; j < 3; ++j) both[3 * j + i] = column[j];
  }
  return both;
}

}  // namespace

Patch Patch::through(int x0, int y0, int x1, int y1, const std::array<CrsPoint, 9>& nodes) {
  Patch patch{x0, y0, x1, y1};
  std::array<double, 9> u{}, v{};
  std::ranges::transform(nodes, u.begin(), &CrsPoint::x);
  std::ranges::transform(nodes, v.begin(), &CrsPoint::y);
  patch.u = coefficients(u);
  patch.v = coefficients(v);
  return patch;
}

PixelBox Patch::box() const {
  PixelBox box;
  for (int k = 0; k < 9; ++k) {
    const CrsPoint node = at(k % 3 - 1.0, k / 3 - 1.0);
    if (k == 0) box = {node.x, node.y, node.x, node.y};
    box = {std::min(box.u0, node.x), std::min(box.v0, node.y), std::max(box.u1, node.x), std::max(box.v1, node.y)};
  }
  // A parabola leaves the range of its three nodes by at most a quarter of its bend.
  const auto bend = [](const std::array<double, 9>& c) {
    return 0.25 * (std::abs(c[2]) + std::abs(c[5]) + 2.0 * std::abs(c[8]) + std::abs(c[6]) + std::abs(c[7]));
  };
  return {box.u0 - bend(u), box.v0 - bend(v), box.u1 + bend(u), box.v1 + bend(v)};
}

Patch Patch::in(const Affine& level_from_source) const {
  Patch moved = *this;
  for (std::size_t k = 0; k < 9; ++k) {
    moved.u[k] = level_from_source.x_per_column * u[k] + level_from_source.x_per_row * v[k];
    moved.v[k] = level_from_source.y_per_column * u[k] + level_from_source.y_per_row * v[k];
  }
  moved.u[0] += level_from_source.x0;
  moved.v[0] += level_from_source.y0;
  return moved;
}

Patch Patch::part(int from_x, int from_y, int to_x, int to_y) const {
  std::array<CrsPoint, 9> nodes{};
  for (int k = 0; k < 9; ++k) {
    const double x = std::lerp(double(from_x), double(to_x), 0.5 * (k % 3));
    const double y = std::lerp(double(from_y), double(to_y), 0.5 * (k / 3));
    nodes[static_cast<std::size_t>(k)] = at(s_of(x), t_of(y));
  }
  return through(from_x, from_y, to_x, to_y, nodes);
}

}  // namespace terrella
