#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geo/coordinates.h"
#include "geo/map_plane.h"

namespace terrella {

enum class Overlap { outside, cut, inside };

/// A part of a planet: the union of boxes and polygons. thread: any, once it is built
class Region {
 public:
  /// Nothing yet.
  Region();
  /// A box in geodetic latitude; east < west crosses ±180°.
  void add_box(const GeoRect& box);
  /// A polygon of one or more rings (outer and holes alike) under even-odd filling; points within [-180, 180] and
  /// [-90, 90].
  void add_polygon(const std::vector<MapRing>& rings);
  void add(const Region& other);

  [[nodiscard]] bool empty() const { return boxes_.empty() && segments_.empty(); }

  /// Numbers of the segments that a rectangle was found to touch: where a walk down a quadtree goes on from.
  using Segments = std::vector<std::uint32_t>;
  [[nodiscard]] Segments all_segments() const;
  /// How a rectangle lies to the region. `candidates` are the segments that touch a rectangle around it; `touched`
  /// receives those that touch it. `cut` may be said of a rectangle that only several parts together cover. An area
  /// that shares no more than a border with the rectangle does not overlap it.
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
  std::vector<std::vector<std::uint32_t>> bands_;  ///< segments by latitude, so that a look along a parallel meets few
  std::uint32_t polygons_ = 0;
};

}  // namespace terrella
