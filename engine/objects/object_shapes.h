#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "geo/ellipsoid.h"
#include "geo/objects.h"

namespace terrella {

/// Pieces of a line span no more than this: on Earth their chords lie at most 0.5 m under the surface.
inline constexpr Angle kLineStep = Angle::degrees(0.045);

/// How far a chord of that angle lies under the surface at most, metres.
[[nodiscard]] double sag_m(const Ellipsoid& ellipsoid, Angle step);

/// ECEF positions, metres, along the geodesics through `places`, pieces no longer than `step`; heights change evenly.
/// Lines that do not go under the ground are lifted by their sag, so that no piece of them does. Error of the
/// geodesics: nanometres (GeographicLib, Karney 2013, doi:10.1007/s00190-012-0578-z). thread: any
[[nodiscard]] std::vector<glm::dvec3> line_along_geodesics(const std::vector<Geodetic>& places,
                                                           const Ellipsoid& ellipsoid, Angle step);

/// The same along the edges that areas have: great circles of the sphere of geodetic latitude and longitude
/// (geo/great_circle.h), closed, and lifted by `lift_m`.
[[nodiscard]] std::vector<glm::dvec3> outline(const std::vector<Geodetic>& ring, const Ellipsoid& ellipsoid, Angle step,
                                              double lift_m);

/// The length of a line through places as an angle on the sphere: what its number of pieces follows from.
[[nodiscard]] Angle length_of(const std::vector<Geodetic>& places);

/// Triangles of an area on the ellipsoid, cut at a grid of latitudes and longitudes so fine that they follow it, and
/// lifted by their sag. Grid cells span 1° in large areas and 1/64 of the extent in small ones, at least 0.05°.
struct FillMesh {
  std::vector<glm::dvec3> positions_m;  ///< ECEF
  std::vector<std::uint32_t> indices;
  double lift_m = 0.0;  ///< how much higher than its places it lies
};

/// Of all places of an area; 0 without any.
[[nodiscard]] double mean_height_m(const PolygonObject& polygon);

/// Fills an area, poles and ±180° included. Nothing if a ring cannot be an area's (geo/great_circle.h), or if it takes
/// more than `most_triangles`. thread: any
[[nodiscard]] FillMesh fill_area(const PolygonObject& polygon, const Ellipsoid& ellipsoid, std::size_t most_triangles);

}  // namespace terrella
