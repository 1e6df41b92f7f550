#pragma once

#include <memory>

#include "streaming/raster/gdal/gdal_library.h"

namespace terrella {

struct DestroyTransformation {
  void operator()(OGRCoordinateTransformationH way) const { gdal().OCTDestroyCoordinateTransformation(way); }
};
using Transformation = std::unique_ptr<void, DestroyTransformation>;

/// The way from a coordinate system to longitude and latitude on WGS84, or on the system's own body. Heights of a
/// system that has them become heights over the ellipsoid, where PROJ has the grid. Null if there is no way. GDAL is
/// loaded. thread: any
[[nodiscard]] Transformation way_to_degrees(OGRSpatialReferenceH system);

/// The way from longitude, latitude and height over the sea (EGM96, as in KML) to heights over the ellipsoid. Null if
/// PROJ lacks the grid. GDAL is loaded. thread: any
[[nodiscard]] Transformation way_from_sea_level();

}  // namespace terrella
