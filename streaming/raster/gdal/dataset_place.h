#pragma once

#include <optional>

#include "streaming/georeference/georeference.h"
#include "streaming/raster/gdal/gdal_library.h"

namespace terrella {

/// A place that is stated by points instead of a grid.
enum class PointPlace { none, control_points, camera };

/// The points by which a dataset must be resampled; none if it states a grid, or nothing.
[[nodiscard]] PointPlace points_of(GDALDatasetH dataset);

/// The statement of a dataset about its place; none if it states neither a grid nor points nor a coordinate system.
/// `resampled`: the same raster on a grid; null if its points are not used.
[[nodiscard]] std::optional<Georeference> read_place(GDALDatasetH dataset, GDALDatasetH resampled);

}  // namespace terrella
