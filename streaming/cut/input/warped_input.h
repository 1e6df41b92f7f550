#pragma once

#include <memory>
#include <optional>

#include "base/result.h"
#include "geo/coordinates.h"
#include "streaming/cut/input/height_input.h"
#include "streaming/cut/input/row_reader.h"
#include "streaming/georeference/placement.h"

namespace terrella {

/// A picture of any projection, resampled to the pixels of a grid from (-180°, 90°).
struct WarpedInput {
  std::unique_ptr<RowReader> rows;
  std::optional<GeoRect> bounds;  ///< none: the whole planet
};

/// Opens a picture by its transform. With `heights`, rows are in units of the tiles' numbers. thread: any
[[nodiscard]] Result<WarpedInput> open_warped(const PictureFile& picture, const CrsPlace& from,
                                              const std::optional<HeightPlan>& heights);

}  // namespace terrella
