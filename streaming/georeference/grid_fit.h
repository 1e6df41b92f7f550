#pragma once

#include <cstdint>

#include "geo/coordinates.h"
#include "streaming/georeference/placement.h"

namespace terrella {

/// Relation of a picture in even steps of degrees to a grid of its own pixels. Such a grid begins at (-180°, 90°), or
/// less than a pixel beyond.
enum class GridFit {
  as_it_is,  ///< its pixels are the grid's
  rolled,    ///< its pixels are the grid's, and it goes round the planet from another column than the grid's first
  none       ///< its pixels are not square, reach beyond the planet, or do not meet their own columns after a turn
};

/// A picture on the pixels of a grid.
struct FittedPlace {
  GridFit fit = GridFit::none;
  GeoRect bounds{};               ///< area; east < west if it crosses ±180°. All longitudes if rolled
  bool whole_planet = false;      ///< `bounds` is the planet
  std::int64_t turn_px = 0;       ///< pixels of 360°; 0 if 360° is not a whole number of pixels
  std::int64_t first_column = 0;  ///< column of the grid of the picture's first column, in [0, turn_px) if that is set
};

/// Finds the grid's pixels that the picture covers. Edges may lie 0.01 pixels off. thread: any
[[nodiscard]] FittedPlace fit_to_grid(const PictureFile& picture, const Placement& place);

}  // namespace terrella
