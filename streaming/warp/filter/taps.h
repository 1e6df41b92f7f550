#pragma once

#include <cstdint>
#include <vector>

#include "streaming/warp/map/patch.h"

namespace terrella {

/// Weighted sum for one column or row: source pixels from `first` on, with weights that add up to 1.
struct Taps {
  std::int64_t first = 0;
  std::vector<float> weights;
};

/// A cubic of Mitchell and Netravali (1988) around `centre`, in pixels from the outer edge of the first. For a `length`
/// up to one pixel it is Catmull-Rom's (B = 0, C = 1/2). A larger length makes it a low-pass filter of that many
/// pixels. Weights of 0 at the ends are left out. thread: any
[[nodiscard]] Taps cubic_taps(double centre, double length);
/// The cubic itself, at a distance from its middle; `length` ≥ 1. Its second moment, B · length² / 3, is that of a mean
/// over `length` pixels less that of a source pixel, which already is a mean: B = (1 - 1 / length²) / 4, C = (1 - B)
/// / 2. The result therefore droops as the mean of the tile's pixel does.
[[nodiscard]] double cubic(double distance, double length);

/// Taps of a column or row of a tile, and the fraction of it that lies on the source, [0, 1].
struct LineTaps {
  Taps taps;
  float coverage = 0.0F;
};
/// A column or row of a tile in source pixels: its edges and its middle.
struct Line {
  double before = 0.0, middle = 0.0, after = 0.0;
};
/// `size` is the number of source pixels; 0: endless.
[[nodiscard]] LineTaps line_taps(const Line& line, double size);

/// Shape of the cubic in two dimensions, in source pixels: an ellipse, as Heckbert's elliptical weighted average
/// (1989). Row by row it is a cubic whose middle moves along: u - shear · (v - middle of v).
struct KernelShape {
  double length_u = 1.0;  ///< along a row
  double length_v = 1.0;
  double shear = 0.0;
  /// Reach to each side of the middle.
  [[nodiscard]] double reach_u() const { return 2.0 * (length_u + std::abs(shear) * length_v); }
  [[nodiscard]] double reach_v() const { return 2.0 * length_v; }
};
[[nodiscard]] KernelShape kernel_shape(const Jacobian& jacobian);

/// The fraction of a pixel of the tile that lies on a source of `size` pixels, in one direction of the source, if the
/// pixel's middle is at `at` there. `by_x` and `by_y` are the source pixels per pixel of the tile.
[[nodiscard]] double covered(double at, double size, double by_x, double by_y);

}  // namespace terrella
