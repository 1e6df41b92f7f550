#pragma once

#include <optional>

#include "geo/camera.h"
#include "geo/coordinates.h"
#include "geo/ellipsoid.h"

namespace terrella {

/// A box round the part of a planet that a camera shows, somewhat larger; with the horizon in the picture, all within
/// it. nullopt if the picture shows no part of the planet. Heights are left out of account. thread: any
[[nodiscard]] std::optional<GeoRect> view_box(const Camera& camera, const Ellipsoid& ellipsoid, Viewport viewport);

}  // namespace terrella
