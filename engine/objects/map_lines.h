#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "view/ground.h"

namespace terrella {

enum class MapLineKind { coast, border };

/// A line of a map: straight in latitude and longitude between neighbouring places, the short way round.
struct MapLine {
  MapLineKind kind = MapLineKind::coast;
  std::vector<Geodetic> places;  ///< heights do not count
};

/// A visible piece of a line, in pixels of the picture. It may extend a little past the picture's edges.
struct MapPiece {
  MapLineKind kind = MapLineKind::coast;
  std::vector<glm::dvec2> points_px;  ///< at least 2
};

/// The lines of a map, prepared for drawing at any distance. A place is dropped where the picture does not show the
/// difference (Douglas and Peucker, 1973). The distances at which a line changes are powers of two, so that lines
/// keep their places while the camera moves. thread: any for the constructor, the ground's thread for trace()
class MapLines {
 public:
  /// Takes about half a microsecond per place.
  MapLines(const std::vector<MapLine>& lines, const Ellipsoid& ellipsoid);

  /// Returns the visible pieces on the drawn ground, within `error_px` of the lines. Lines behind the horizon of the
  /// ellipsoid are left out; mountains hide nothing. Small closed lines whose radius is less than
  /// the error are left out. None from under the ground.
  [[nodiscard]] std::vector<MapPiece> trace(const View& view, const Ground& ground, double error_px) const;

 private:
  struct Vertex {
    glm::dvec3 unit;     ///< place on the unit sphere to which the ellipsoid is scaled
    float importance_m;  ///< distance by which the line moves without this place
  };
  /// A part of a line with its bounding sphere. Its last vertex is the first one of the next part.
  struct Part {
    std::size_t first = 0, count = 0;
    glm::dvec3 middle_m{0.0};
    double radius_m = 0.0;
  };
  struct Line {
    MapLineKind kind = MapLineKind::coast;
    std::size_t first_part = 0, parts = 0;
    double closed_radius_m = 0.0;  ///< 0: not closed
  };
  friend class MapTracer;

  void add(const MapLine& line);
  void add_parts(Line& line, std::size_t first);
  void weigh(std::size_t first, std::size_t last, float most_m);

  Ellipsoid ellipsoid_;
  glm::dvec3 half_axes_m_;
  std::vector<Vertex> vertices_;
  std::vector<Part> parts_;
  std::vector<Line> lines_;
};

}  // namespace terrella
