#pragma once

#include <array>
#include <cmath>
#include <string>

namespace terrella {

/// A point in a coordinate reference system, or longitude and latitude.
struct CrsPoint {
  double x = 0.0;
  double y = 0.0;
};

/// Transform from pixel coordinates to map coordinates. Pixel coordinates begin at the outer corner of the first pixel,
/// x to the right and y down, so the middle of the first pixel is (0.5, 0.5).
struct Affine {
  double x0 = 0.0, x_per_column = 1.0, x_per_row = 0.0;
  double y0 = 0.0, y_per_column = 0.0, y_per_row = -1.0;

  [[nodiscard]] CrsPoint at(double column, double row) const {
    return {x0 + x_per_column * column + x_per_row * row, y0 + y_per_column * column + y_per_row * row};
  }
  /// Converts a transform given for the middle of the first pixel.
  [[nodiscard]] Affine from_centre() const {
    Affine corner = *this;
    corner.x0 -= 0.5 * (x_per_column + x_per_row);
    corner.y0 -= 0.5 * (y_per_column + y_per_row);
    return corner;
  }
  [[nodiscard]] bool is_finite() const {
    bool finite = true;
    for (const double value : {x0, x_per_column, x_per_row, y0, y_per_column, y_per_row}) {
      finite = finite && std::isfinite(value) && std::abs(value) < 1e15;
    }
    return finite && std::abs(x_per_column * y_per_row - x_per_row * y_per_column) > 1e-30;
  }
  [[nodiscard]] bool is_turned() const { return x_per_row != 0.0 || y_per_column != 0.0; }
};

/// Place of a picture: the transform of its pixels to a coordinate system that PROJ knows.
struct CrsPlace {
  Affine to_crs;    ///< transform of the full-size picture, pixel-is-area
  std::string crs;  ///< text for Crs::open()
};

}  // namespace terrella
