#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <vector>

#include "objects/area/area_rings.h"

class GLUtesselator;

namespace terrella {

/// GLU's tessellator, even-odd. Time and memory grow with the number of crossings, up to the square of the number of
/// points. thread: any, but one call at a time
class AreaTessellator {
 public:
  AreaTessellator();
  ~AreaTessellator();
  AreaTessellator(const AreaTessellator&) = delete;
  AreaTessellator& operator=(const AreaTessellator&) = delete;

  /// Returns vertices of triangles, three per triangle.
  [[nodiscard]] const std::vector<MapPoint>& triangles(const MapRings& rings);
  /// Returns how often edges crossed in all calls.
  [[nodiscard]] std::size_t crossings() const { return crossings_; }

 private:
  using Point = std::array<double, 3>;
  static void on_vertex(void* vertex, void* self);
  static void on_combine(const double at[3], void* const met[4], const float weights[4], void** made, void* self);
  static void on_edge(unsigned char) {}

  GLUtesselator* tess_;
  std::deque<Point> points_;  // a deque, because addresses must stay valid
  std::vector<MapPoint> corners_;
  std::size_t crossings_ = 0;
};

}  // namespace terrella
