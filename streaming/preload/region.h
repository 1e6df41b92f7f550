#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/coordinates.h"
#include "geo/map_plane.h"

namespace terrella {

enum class Overlap { outside, cut, inside };

/// A part of a planet: a union of boxes and polygons. thread: any, after it is built
class Region {
 public:
  /// Adds a box in geodetic latitude. East < west crosses ±180°.
  void add_box(const GeoRect& box);
  /// Adds a polygon with one or more rings, filled by the even-odd rule, so outer rings and holes need no marks. Points
  /// lie within [-180, 180] and [-90, 90].
  void add_polygon(const std::vector<MapRing>& rings);
  void add(const Region& other);

  /// Number of tiles of this span that the edges of polygons pass, each counted for each edge, about. A walk down to
  /// these tiles takes so many steps.
  [[nodiscard]] double edge_steps(double tile_span_deg) const;

  [[nodiscard]] bool empty() const { return boxes_.empty() && segments_.empty(); }

  /// The region as a rectangle sees it: the segments that touch the rectangle, in order, and the polygons that contain
  /// the rectangle's middle. A walk down a quadtree passes these to the next level, so that its cost grows with the
  /// segments that rectangles touch alone.
  struct Sight {
    MapPoint middle;
    std::vector<std::uint32_t> segments;
    std::vector<std::uint32_t> around;  ///< polygons, in order
  };
  /// The region as seen by a rectangle around everything.
  [[nodiscard]] Sight whole() const;
  /// Classifies a rectangle against the region. `outer` is the sight of an enclosing rectangle. `seen` receives the
  /// rectangle's own sight if the result is `cut`. May return `cut` for a rectangle that only several parts together
  /// cover. Areas that share only a border do not overlap.
  [[nodiscard]] Overlap classify(const MapRect& rect, const Sight& outer, Sight& seen) const;

 private:
  struct Segment {
    MapPoint a, b;  ///< in order of longitude, then latitude
    std::uint32_t polygon;
  };
  [[nodiscard]] std::vector<std::uint32_t> around(const MapPoint& place, const Sight& outer) const;

  std::vector<MapRect> boxes_;
  std::vector<Segment> segments_;  ///< in the order of their polygons
  std::uint32_t polygons_ = 0;
};

}  // namespace terrella
