#pragma once

#include <string>

#include "base/result.h"
#include "geo/ellipsoid.h"
#include "streaming/cut/cut_plan.h"

namespace terrella {

/// Pixels of a picture's own grid that lie under a place, counted from the outer corner of the picture's first pixel.
[[nodiscard]] double picture_column(const CutPlan& picture, double lon_deg);
/// The same for rows; `latitude` is geodetic.
[[nodiscard]] double picture_row(const CutPlan& picture, const Ellipsoid& figure, Angle latitude);

/// Edges of the columns and rows of a plan in Web Mercator. Longitudes go on beyond 180° if the plan does.
[[nodiscard]] double mercator_lon_deg(const CutPlan& plan, double column);
[[nodiscard]] Angle mercator_latitude(const CutPlan& plan, double row);

/// Place of a picture in the grid of Web Mercator, with the coarsest finest level whose pixels at the equator are no
/// larger than the picture's. Level 0 is one tile of the whole square; two by two of them if the picture crosses ±180°,
/// so that its sides meet in no tile. The plan covers each pixel that the picture touches, or with `halves` each one
/// that the picture covers at least by half. Latitudes beyond the square are left out. Fails if nothing of the picture
/// lies in the square, if the level is too fine, or for a tile size that Web Mercator does not have. The error begins
/// with `name`. thread: any
[[nodiscard]] Result<CutPlan> mercator_plan(const CutPlan& picture, const Ellipsoid& figure, bool halves,
                                            const std::string& name);

/// True if the picture reaches beyond the square's northern or southern end by more than a pixel.
[[nodiscard]] bool reaches_beyond_mercator(const CutPlan& picture, const Ellipsoid& figure);

}  // namespace terrella
