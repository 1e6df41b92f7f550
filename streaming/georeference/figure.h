#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "geo/body.h"
#include "streaming/georeference/placement.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// Checks that the picture states no other body (a radius over 1 % from `body`'s; a sphere stands for a flattened body
/// of its radius). Returns the latitude that its rows count: `asked` if given, with a remark if the picture states
/// otherwise; else as the picture states. thread: any
[[nodiscard]] Result<LatitudeKind> check_figure(PlacedPicture& placed, const Body& body,
                                                std::optional<LatitudeKind> asked);

/// Value of --body for a coordinate system: the name of a preset within 1 %, or "A,F". thread: any
[[nodiscard]] std::string body_name(const CrsFacts& crs);

/// Latitude that a coordinate system counts on a body: planetocentric if its name says so, or on a sphere that stands
/// for a flattened body other than the Earth. thread: any
[[nodiscard]] LatitudeKind latitude_of(const CrsFacts& crs, const Body& body);

/// True if a radius of two bodies differs by over 1 %. A sphere stands for a flattened body of its equatorial radius.
/// thread: any
[[nodiscard]] bool are_two_bodies(const Body& one, const Body& other);

/// Body of a coordinate system: the name of a preset, or "A,F"; empty for the Earth, the default.
[[nodiscard]] std::string stated_body(const CrsFacts& crs);
/// The same of the system that the user's words or a picture name; empty if they name none that PROJ knows. thread: any
[[nodiscard]] std::string stated_body(const PictureFile& picture, const PlaceWords& words);

}  // namespace terrella
