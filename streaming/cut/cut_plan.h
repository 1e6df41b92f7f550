#pragma once

#include <cstdint>
#include <vector>

#include "base/result.h"
#include "streaming/cut.h"
#include "streaming/cut/input/row_reader.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// A half-open rectangle of pixels of one level, counted from the grid's origin.
struct PixelRect {
  std::int64_t x0, y0, x1, y1;
};

/// Position of a picture in a grid, without resampling.
struct CutPlan {
  TileGrid grid;
  /// Area covered by the picture at grid.max_level. Its height may exceed the picture's height by one. Its x1 is beyond
  /// turn_px if the picture crosses ±180°.
  PixelRect finest{};
  std::int64_t turn_px = 0;       ///< pixels of 360° at the finest level; set if the picture crosses ±180°
  bool wraps = false;             ///< the columns go round the planet: finest.x0 = 0, finest.x1 = 360°
  double pixel_deg = 0.0;         ///< pixel size at the finest level
  std::int64_t picture_rows = 0;  ///< rows in the picture; the last row is used twice if `finest` has one more
};

/// A part of the picture with contiguous columns in the grid.
struct CutPiece {
  CutPlan plan;                   ///< plan of this piece alone
  std::int64_t first_column = 0;  ///< column in the picture's rows
};

/// Fails if an option is out of the range that streaming/cut.h states, and names the option. thread: any
[[nodiscard]] Status check_options(const CutOptions& options);

/// Makes a plan, or reports why the cut is impossible and what to do: a picture that is not 2:1 without bounds, bounds
/// with pixels that are not square or not aligned with their own grid, options out of range. Reads no file. thread: any
[[nodiscard]] Result<CutPlan> plan_cut(const PictureInfo& picture, const CutOptions& options);

/// A cut before its first pixel is read.
struct PlannedCut {
  TileSetInfo info;  ///< description of the result
  CutPlan plan;
};
/// Opens the pictures and plans their cut; fails as cut() would. Blocks. thread: any
[[nodiscard]] Result<PlannedCut> plan_pictures(const CutOptions& options);

/// The grid of a picture's own pixels; nothing if the picture would be resampled. thread: any
[[nodiscard]] Result<std::optional<TileGrid>> grid_of_pixels(const CutOptions& options, const PictureFile& picture);

/// The whole picture, or its two parts on either side of ±180°. thread: any
[[nodiscard]] std::vector<CutPiece> pieces_of(const CutPlan& plan);

/// True if a picture covers the planet, or the square of Web Mercator. thread: any
[[nodiscard]] bool is_planet(const CutPlan& plan);

/// Every pixel of a level that contains a part of the picture.
[[nodiscard]] PixelRect pixels_at(const CutPlan& plan, int level);

/// Area of a row of the finest level between its two latitudes, on the unit sphere, per radian of longitude. 1 for
/// equal-area grids. Parts beyond a pole have no area.
[[nodiscard]] double finest_row_area(const CutPlan& plan, std::int64_t y);

}  // namespace terrella
