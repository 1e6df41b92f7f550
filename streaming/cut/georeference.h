#pragma once

#include <filesystem>
#include <optional>

#include "geo/coordinates.h"

namespace terrella {

/// Where a picture says that it lies.
struct Georeference {
  double west_deg = 0.0;   ///< of the first pixel's outer edge
  double north_deg = 0.0;  ///< of the first row's outer edge
  double pixel_width_deg = 0.0;
  double pixel_height_deg = 0.0;  ///< > 0: rows go south
};

/// From a TIFF's geographic GeoTIFF tags (OGC 19-008r4: pixel scale, tie point, raster type), else from a world file
/// beside the picture (.jgw, .pgw, .tfw, .wld: x and y of the middle of the first pixel). None if it has neither, is
/// turned, or is in metres: what cannot be longitudes and latitudes. thread: any
[[nodiscard]] std::optional<Georeference> read_georeference(const std::filesystem::path& picture);

/// What `width` × `height` such pixels cover; east < west if it crosses ±180°. None for all longitudes from elsewhere
/// than -180°, which no rectangle says. Within a hundredth of a pixel of the whole planet it is the whole planet.
[[nodiscard]] std::optional<GeoRect> covered_by(const Georeference& place, std::int64_t width, std::int64_t height);

}  // namespace terrella
