#pragma once

#include <cstdint>
#include <vector>

#include "base/result.h"
#include "streaming/cut.h"
#include "streaming/cut/input/row_reader.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// A half-open rectangle of a level's pixels, counted from the grid's origin.
struct PixelRect {
  std::int64_t x0, y0, x1, y1;
};

/// How a picture is laid into a grid without resampling.
struct CutPlan {
  TileGrid grid;
  PixelRect finest{};  ///< what the picture covers at grid.max_level; its height may exceed the picture's by one, and
                       ///< x1 is beyond turn_px if it crosses ±180°
  std::int64_t turn_px = 0;       ///< 360° at the finest level, if the picture crosses ±180°
  bool wraps = false;             ///< its columns go round the planet: finest.x0 = 0, finest.x1 = 360°
  double pixel_deg = 0.0;         ///< at the finest level
  std::int64_t picture_rows = 0;  ///< rows that the picture really has; the last stands for one more if there is one
};

/// A part of the picture whose columns lie together in the grid.
struct CutPiece {
  CutPlan plan;                   ///< of this piece alone
  std::int64_t first_column = 0;  ///< in the picture's rows
};

/// Plans, or says why it cannot be done and what to do: a picture that is not 2:1 without bounds, bounds whose pixels
/// are not square or do not align with their own grid, options out of range. Reads nothing. thread: any
[[nodiscard]] Result<CutPlan> plan_cut(const PictureInfo& picture, const CutOptions& options);

/// The picture itself, or, of one that crosses ±180°, what lies on either side of it. thread: any
[[nodiscard]] std::vector<CutPiece> pieces_of(const CutPlan& plan);

/// What the picture covers at a level: every pixel that holds a part of it.
[[nodiscard]] PixelRect pixels_at(const CutPlan& plan, int level);

/// The area of a finest row between its two latitudes on the unit sphere, per radian of longitude; 1 for equal-area
/// grids. Parts beyond a pole have none.
[[nodiscard]] double finest_row_area(const CutPlan& plan, std::int64_t y);

}  // namespace terrella
