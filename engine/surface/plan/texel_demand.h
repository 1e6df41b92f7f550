#pragma once

#include <cstdint>

#include "geo/camera.h"
#include "surface/patch_tree.h"

namespace terrella {

/// Computes the texels that the cells of a view ask for. A patch has the level of its nearest part; a cell that asks
/// for less may take a coarser tile. thread: any
class TexelDemand {
 public:
  TexelDemand(const View& view, const Ellipsoid& ellipsoid, const TileGrid& grid, double texels_per_pixel);

  /// Levels by which the tile of a cell may be coarser. `most_texels`: coarse_enough(id.level).
  [[nodiscard]] int levels_to_spare(const TileId& id, const CellExtent& cell, double most_texels) const;
  /// Most texels of level 0 a pixel for which the level above is fine enough.
  [[nodiscard]] static double coarse_enough(int level);
  /// True if this many tiles have far more texels than the view has pixels. Tiles of a full grid get ever narrower
  /// towards a pole, and a view from over the pole wants many that it hardly shows.
  [[nodiscard]] bool is_too_much(int tiles) const;
  /// Lets narrow texels be longer than a pixel along the meridian from now on.
  void lengthen_narrow_texels() { narrow_texels_are_long_ = true; }

 private:
  /// Texels of level 0 that a pixel asks for along the meridian and, of the full grid, along the parallel.
  struct Texels {
    double meridian, parallel;
  };
  [[nodiscard]] Texels wanted(const CellExtent& cell) const;
  [[nodiscard]] double length_px(double cos_lat2) const;

  const View& view_;
  const TileGrid& grid_;
  double texels_per_pixel_;
  double radians_per_pixel_;
  double texel0_asked_m_;  ///< height of a texel of level 0, times texels_per_pixel_
  bool narrow_texels_are_long_ = false;
};

}  // namespace terrella
