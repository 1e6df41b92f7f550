#pragma once

#include "apps/program/scene_picture.h"
#include "streaming/georeference/georeference.h"

namespace terrella {

/// Options of `terrella render --extent`.
struct MapCommand {
  RenderCommand render;  ///< `output` ends in .tif or .tiff; `scene.size` is the most that the map's sides have
  std::string crs;       ///< coordinate system of the map
  CrsBounds extent;      ///< in units of `crs`, easting first
};

/// Fails if the extent is empty or the output is no GeoTIFF; an error means wrong usage. thread: any
[[nodiscard]] Status check_together(const MapCommand& command);

/// Writes the scene's images and numbers as a georeferenced map, reports as the program does and returns the exit code.
/// Light, air, relief and objects are not drawn. thread: main
int run_map(const MapCommand& command);

}  // namespace terrella
