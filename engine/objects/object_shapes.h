#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "geo/ellipsoid.h"
#include "geo/objects.h"

// thread: any, for all of this header
namespace terrella {

/// Largest span of a line's piece. On Earth its chord lies at most 0.5 m under the surface.
inline constexpr Angle kLineStep = Angle::degrees(0.045);

/// Returns the largest depth of a chord of that angle under the surface, metres.
[[nodiscard]] double sag_m(const Ellipsoid& ellipsoid, Angle step);

/// Returns ECEF positions, metres, along the geodesics through `places`, in pieces no longer than `step`. Heights
/// change evenly. Lines that do not go under the ground are raised by their sag, so that no piece goes under the ground
/// either. Error of the geodesics: nanometres (GeographicLib, Karney 2013, doi:10.1007/s00190-012-0578-z). thread: any
[[nodiscard]] std::vector<glm::dvec3> line_along_geodesics(const std::vector<Geodetic>& places,
                                                           const Ellipsoid& ellipsoid, Angle step);

/// Returns geodetic normals along the geodesics through `places`, in pieces no longer than `step`.
[[nodiscard]] std::vector<EcefDir> normals_along_geodesics(const std::vector<Geodetic>& places,
                                                           const Ellipsoid& ellipsoid, Angle step);

/// Returns ECEF positions, metres, along the edges of an area: great circles of the sphere of geodetic latitude and
/// longitude (geo/great_circle.h), closed, and raised by `lift_m`.
[[nodiscard]] std::vector<glm::dvec3> outline(const std::vector<Geodetic>& ring, const Ellipsoid& ellipsoid, Angle step,
                                              double lift_m);

/// Returns the level direction at a place under a heading, clockwise from north: unit, ECEF.
[[nodiscard]] glm::dvec3 level_direction(const Geodetic& place, Angle heading);

/// Returns the length of a line through places, as an angle on the sphere. The number of pieces follows from this
/// length.
[[nodiscard]] Angle length_of(const std::vector<Geodetic>& places);

/// Reason why an area has no fill.
enum class FillFault {
  none,
  invalid,             ///< a ring is invalid (geo/great_circle.h)
  too_many_triangles,  ///< limit for all areas of the layer
  tangled,             ///< too many edges cross or almost lie on each other
};

/// An area that is drawn without its fill.
struct MissingFill {
  ObjectId id{};
  FillFault fault = FillFault::none;
};

/// Text of a fault with its cure, for messages.
[[nodiscard]] const char* to_text(FillFault fault);

/// Triangles of an area on the ellipsoid, cut at a grid of latitudes and longitudes that is fine enough to follow the
/// ellipsoid, and raised by their sag. Grid cells span 1° in large areas, and 1/64 of the extent in small ones, at
/// least 0.05°.
struct FillMesh {
  std::vector<glm::dvec3> positions_m = {};  ///< ECEF
  std::vector<std::uint32_t> indices = {};
  double lift_m = 0.0;  ///< height of the mesh over the height of the area's places
  FillFault fault = FillFault::none;
  std::size_t steps = 0;        ///< points that were clipped or tessellated, and crossings: what the mesh cost
  std::size_t spare_steps = 0;  ///< steps beyond those due to an area of its length
};

/// Steps that the areas of a layer may take together beyond those due to their lengths; about a second.
inline constexpr std::size_t kSpareFillSteps = 8'000'000;

/// Mean height of all places of an area; 0 if there are none.
[[nodiscard]] double mean_height_m(const PolygonObject& polygon);

/// Fills an area, also over poles and ±180°, even-odd. Empty if equal rings cancel each other, or if there is a fault.
/// Steps, hence time, are limited: they grow with the points of the area and the cells that its edges pass.
/// `spare_steps` may come on top. thread: any
[[nodiscard]] FillMesh fill_area(const PolygonObject& polygon, const Ellipsoid& ellipsoid, std::size_t most_triangles,
                                 std::size_t spare_steps = kSpareFillSteps);

}  // namespace terrella
