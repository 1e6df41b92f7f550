#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "geo/cube_sphere.h"
#include "geo/ellipsoid.h"
#include "geo/objects.h"
#include "objects/object_shapes.h"

// Lines and areas that lie on the ground, in the coordinates of the patches under them. thread: any
namespace terrella {

/// A rectangle of face coordinates (FacePoint, tangent mapping). It may reach over the face.
struct FaceBox {
  double west = 9.0, south = 9.0, east = -9.0, north = -9.0;
  void add(const glm::dvec2& p) {
    west = p.x < west ? p.x : west;
    east = p.x > east ? p.x : east;
    south = p.y < south ? p.y : south;
    north = p.y > north ? p.y : north;
  }
  void add(const FaceBox& box) {
    if (box.empty()) return;
    add(glm::dvec2(box.west, box.south));
    add(glm::dvec2(box.east, box.north));
  }
  [[nodiscard]] bool empty() const { return west > east; }
  [[nodiscard]] bool meets(const FaceBox& o) const {
    return west <= o.east && o.west <= east && south <= o.north && o.south <= north;
  }
};

/// Use of a run's pieces.
enum class RunUse : std::uint8_t { both, fill, stroke };

/// Consecutive points of a way: pieces from points[first + k] to points[first + k + 1], k < pieces. A piece is a great
/// circle of geodetic normals.
struct GroundRun {
  std::uint32_t first = 0, pieces = 0;
  RunUse use = RunUse::both;
  double along_rad = 0.0;  ///< length of the way before the run, as an angle
  FaceBox box;
};

/// The part of a shape on a face and a little around it.
struct GroundPart {
  CubeFace face = CubeFace::pos_x;
  FaceBox box;
  std::vector<glm::dvec2> points;
  std::vector<GroundRun> runs;
};

/// A line, or the rings of an area, on the ground. Of a point on a face, an odd number of pieces with RunUse::both or
/// ::fill to its west tells that it lies in the area.
struct GroundShape {
  std::vector<GroundPart> parts;
  FillFault fault = FillFault::none;
};

/// Parts reach this far over their face, in face coordinates.
inline constexpr double kOverFace = 1.1666;

/// `from_rad`: length of the way before the line.
[[nodiscard]] GroundShape ground_shape(const LineObject& line, const Ellipsoid& ellipsoid, double from_rad = 0.0);
/// `fill`: false leaves out what only the fill needs.
[[nodiscard]] GroundShape ground_shape(const PolygonObject& area, bool fill);

}  // namespace terrella
