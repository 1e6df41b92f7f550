#pragma once

#include <glm/vec3.hpp>

#include "geo/angle.h"

/// All coordinate systems of Terrella, in one place. Other files refer to this one. Plain values. thread: any
///
/// ECEF       Earth-centred, Earth-fixed, right-handed, metres, double. +x to 0°N 0°E, +y to 0°N 90°E, +z to the
///            north pole. Other bodies use their own prime meridian and pole.
/// geodetic   latitude of the surface normal (planetographic), north positive, [-90°, 90°]; longitude east
///            positive, [-180°, 180°]; height along that normal over the ellipsoid, metres.
/// normal     the unit geodetic surface normal n in ECEF axes: latitude = atan2(n.z, hypot(n.x, n.y)), longitude =
///            atan2(n.y, n.x). The cube sphere is a tessellation of the sphere of normals (engine/DESIGN.md, 1).
/// split      ECEF positions as two floats, high + low (geo/split_position.h), in the form that the GPU gets.
/// view       right-handed, metres, origin at the eye: +x right, +y up, -z forward.
/// clip       reversed depth by default: 1 at the near plane, 0 infinitely far; zero-to-one (GL clip control).
/// pixel      origin at the top left corner of the picture, +x right, +y down; pixel centres at halves.
/// tile       columns run east from -180°, rows run south from +90° (TileGrid); uv inside a tile likewise in [0,1].
namespace terrella {

/// A place by latitude, longitude and height, all finite (check_place() in geo/ranges.h). Always name the fields when
/// making one, so that their order cannot be mixed up.
struct Geodetic {
  Angle lat;              ///< geodetic, [-90°, 90°]
  Angle lon;              ///< east positive; input may have any number of turns, results are in (-180°, 180°]
  double height_m = 0.0;  ///< over the ellipsoid, along the surface normal, [-1e12, 1e12]
  bool operator==(const Geodetic&) const = default;
};

/// A position in ECEF metres.
struct Ecef {
  glm::dvec3 xyz_m{0.0};
};

/// A unit direction in ECEF axes.
struct EcefDir {
  glm::dvec3 xyz{0.0, 0.0, 1.0};
};

/// A rectangle of latitudes and longitudes. If east < west, the rectangle crosses the antimeridian.
struct GeoRect {
  Angle west = Angle::degrees(-180.0);
  Angle south = Angle::degrees(-90.0);
  Angle east = Angle::degrees(180.0);
  Angle north = Angle::degrees(90.0);
  bool operator==(const GeoRect&) const = default;
};

}  // namespace terrella
