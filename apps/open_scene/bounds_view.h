#pragma once

#include <optional>

#include "geo/camera.h"
#include "geo/coordinates.h"
#include "geo/ellipsoid.h"
#include "geo/objects.h"
#include "streaming/url.h"

// Views of a part of the planet. thread: any
namespace terrella {

/// Width from the west edge to the east edge, (0°, 360°].
[[nodiscard]] Angle width_of(const GeoRect& bounds);
/// Returns the bounds, or nullopt if they span most of the planet.
[[nodiscard]] std::optional<GeoRect> if_a_part(const GeoRect& bounds);
/// Returns the part of the planet with data: the set's own bounds, or, if these span most of the planet, the bounds of
/// the tiles of a local set: of its first level with tiles of a few degrees. Nullopt for the planet, and if many tiles
/// would have to be looked up. Blocks.
[[nodiscard]] std::optional<GeoRect> part_with_data(const Url& tile_set, const GeoRect& bounds);
/// Bounds of all objects, across ±180° if shorter. Returns nullopt for an empty scene, or if the bounds span most of
/// the planet.
[[nodiscard]] std::optional<GeoRect> bounds_of(const ObjectScene& scene);
/// Looks straight down on the middle, from a height that shows the whole rectangle. `aspect` is the picture's width
/// divided by its height.
[[nodiscard]] Camera camera_over(const GeoRect& bounds, const Ellipsoid& body, Angle fov_y, double aspect);
/// The camera without --camera: straight down on the part with data, else on 20°N 0°E with the whole globe filling the
/// picture.
[[nodiscard]] Camera default_camera(const std::optional<GeoRect>& part, const Ellipsoid& body, Viewport picture);

}  // namespace terrella
