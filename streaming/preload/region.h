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
  /// Makes an empty region.
  Region();
  /// Adds a box in geodetic latitude. East < west crosses ±180°.
  void add_box(const GeoRect& box);
  /// Adds a polygon with one or more rings, filled by the even-odd rule, so outer rings and holes need no marks. Points
  /// lie within [-180, 180] and [-90, 90].
  void add_polygon(const std::vector<MapRing>& rings);
  void add(const Region& other);

  [[nodiscard]] bool empty() const { return boxes_.empty() && segments_.empty(); }

  /// Numbers of the segments that touch a rectangle. A walk down a quadtree passes them to the next level.
  using Segments = std::vector<std::uint32_t>;
  [[nodiscard]] Segments all_segments() const;
  /// Classifies a rectangle against the region. `candidates` are the segments that touch an enclosing rectangle.
  /// `touched` receives those that touch this rectangle. May return `cut` for a rectangle that only several parts
  /// together cover. Areas that share only a border do not overlap.
  [[nodiscard]] Overlap classify(const MapRect& rect, std::span<const std::uint32_t> candidates,
                                 Segments& touched) const;

 private:
  struct Segment {
    MapPoint a, b;
    std::uint32_t polygon;
  };
  [[nodiscard]] bool in_a_polygon(const MapPoint& p) const;
  void add_segment(const MapPoint& a, const MapPoint& b);

  std::vector<MapRect> boxes_;
  std::vector<Segment> segments_;
  /// Segments grouped by latitude, so that a scan along a parallel meets few of them.
  std::vector<std::vector<std::uint32_t>> bands_;
  std::uint32_t polygons_ = 0;
};

}  // namespace terrella
