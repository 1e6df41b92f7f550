#pragma once

#include <nlohmann/json_fwd.hpp>

#include "geo/objects.h"
#include "streaming/objects/object_style.h"

namespace terrella {

/// What the third coordinate of a file's positions means.
enum class ThirdCoordinate { height_m, depth_km };

/// Adds the objects of a GeoJSON geometry to a scene. What is wrong is left out and complained of; the other parts of a
/// Multi geometry stay. thread: any
void add_geometry(const nlohmann::json& geometry, const ObjectStyle& style, ThirdCoordinate third, ObjectScene& scene,
                  const Complain& complain);

}  // namespace terrella
