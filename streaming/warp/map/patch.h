#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "streaming/georeference/georeference.h"

namespace terrella {

/// Derivatives of source pixels by pixels of the tile.
struct Jacobian {
  double u_x = 0.0, u_y = 0.0;
  double v_x = 0.0, v_y = 0.0;
  [[nodiscard]] double determinant() const { return u_x * v_y - u_y * v_x; }
};

/// A rectangle of source pixels; empty if last < first.
struct PixelBox {
  double u0 = 0.0, v0 = 0.0, u1 = 0.0, v1 = 0.0;
};

/// A rectangle of a tile's pixels in which the source pixel (u, v) is a biquadratic function of the place. s and t run
/// from -1 to 1 across the rectangle: u = Σ u[3j + i] sⁱ tʲ. thread: any
struct Patch {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< pixels of the tile; x1 and y1 are excluded
  std::array<double, 9> u{}, v{};

  [[nodiscard]] double s_of(double x) const { return (2.0 * x - x0 - x1) / (x1 - x0); }
  [[nodiscard]] double t_of(double y) const { return (2.0 * y - y0 - y1) / (y1 - y0); }
  [[nodiscard]] CrsPoint at(double s, double t) const { return {value(u, s, t), value(v, s, t)}; }
  [[nodiscard]] Jacobian jacobian(double s, double t) const {
    const double x = 2.0 / (x1 - x0), y = 2.0 / (y1 - y0);
    return {by_s(u, s, t) * x, by_t(u, s, t) * y, by_s(v, s, t) * x, by_t(v, s, t) * y};
  }
  /// Contains the source pixels of the whole patch.
  [[nodiscard]] PixelBox box() const;
  /// The same function in another coordinate system of the source.
  [[nodiscard]] Patch in(const Affine& level_from_source) const;
  /// The same function on a part of the rectangle.
  [[nodiscard]] Patch part(int from_x, int from_y, int to_x, int to_y) const;
  /// A patch through nine nodes: (-1, -1), (0, -1), (1, -1), (-1, 0) …
  [[nodiscard]] static Patch through(int x0, int y0, int x1, int y1, const std::array<CrsPoint, 9>& nodes);

 private:
  static double value(const std::array<double, 9>& c, double s, double t) {
    const auto row = [&](std::size_t j) { return (c[j + 2] * s + c[j + 1]) * s + c[j]; };
    return (row(6) * t + row(3)) * t + row(0);
  }
  static double by_s(const std::array<double, 9>& c, double s, double t) {
    const auto row = [&](std::size_t j) { return 2.0 * c[j + 2] * s + c[j + 1]; };
    return (row(6) * t + row(3)) * t + row(0);
  }
  static double by_t(const std::array<double, 9>& c, double s, double t) {
    const auto row = [&](std::size_t j) { return (c[j + 2] * s + c[j + 1]) * s + c[j]; };
    return 2.0 * row(6) * t + row(3);
  }
};

/// A row of a patch: the source pixel as a parabola over s. thread: any
struct PatchRow {
  PatchRow(const Patch& patch, double t) {
    for (std::size_t i = 0; i < 3; ++i) {
      u[i] = (patch.u[6 + i] * t + patch.u[3 + i]) * t + patch.u[i];
      v[i] = (patch.v[6 + i] * t + patch.v[3 + i]) * t + patch.v[i];
    }
  }
  [[nodiscard]] CrsPoint at(double s) const { return {(u[2] * s + u[1]) * s + u[0], (v[2] * s + v[1]) * s + v[0]}; }
  std::array<double, 3> u{}, v{};
};

}  // namespace terrella
