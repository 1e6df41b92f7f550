#pragma once

#include <optional>

#include "geo/camera.h"
#include "geo/coordinates.h"
#include "geo/ellipsoid.h"

// Views of a part of the planet. thread: any
namespace terrella {

/// Width from the west edge to the east edge, (0°, 360°].
[[nodiscard]] Angle width_of(const GeoRect& bounds);
/// Returns the bounds, or nullopt if they span most of the planet.
[[nodiscard]] std::optional<GeoRect> if_a_part(const GeoRect& bounds);
/// Looks straight down on the middle, from a height that shows the whole rectangle. `aspect` is the picture's width
/// divided by its height.
[[nodiscard]] Camera camera_over(const GeoRect& bounds, const Ellipsoid& body, Angle fov_y, double aspect);

}  // namespace terrella
