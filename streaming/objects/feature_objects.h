#pragma once

#include <nlohmann/json_fwd.hpp>

#include "geo/objects.h"
#include "streaming/objects/object_style.h"

namespace terrella {

/// Meaning of the third coordinate of positions in a file.
enum class ThirdCoordinate { height_m, depth_km };

/// Adds the objects of a GeoJSON geometry to a scene. Skips faulty parts with a complaint; the other parts of a Multi
/// geometry stay. thread: any
void add_geometry(const nlohmann::json& geometry, const ObjectStyle& style, ThirdCoordinate third, ObjectScene& scene,
                  const Complain& complain);

}  // namespace terrella
