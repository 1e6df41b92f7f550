#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geo/coordinates.h"

namespace terrella {

/// A colour as it is shown, sRGB, 0 to 255; alpha 255 is opaque.
struct ObjectColor {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  std::uint8_t alpha = 255;
  bool operator==(const ObjectColor&) const = default;
};

/// A place drawn as a sphere in metres, or else as a disc that keeps its size on the screen.
struct PointObject {
  Geodetic place = {};
  double radius_m = 0.0;  ///< > 0: a sphere around `place`; 0: a marker of `size_px`
  float size_px = 10.0F;  ///< a marker's diameter
  ObjectColor color{230, 60, 50};
  bool through_surface = false;  ///< shines through a surface seen from below that is translucent for chosen objects
};

/// A line through places, by the shortest ways on the ellipsoid (geodesics); heights change evenly on the way.
struct LineObject {
  std::vector<Geodetic> places = {};
  float width_px = 2.0F;
  ObjectColor color{230, 60, 50};
  bool through_surface = false;
};

/// An area with holes: whatever an odd number of rings encloses. Edges, ±180° and poles as geo/great_circle.h says. The
/// fill lies at one height, the mean of its places'; the stroke follows each place's.
struct PolygonObject {
  std::vector<std::vector<Geodetic>> rings = {};  ///< a ring's last place may repeat its first
  ObjectColor fill{230, 60, 50, 90};              ///< alpha 0: none
  ObjectColor stroke{230, 60, 50};                ///< alpha 0: none
  float stroke_width_px = 2.0F;
  bool through_surface = false;
};

/// A text beside a place, right of what marks it there. UTF-8.
struct LabelObject {
  std::string text = {};
  Geodetic place = {};
  ObjectColor color{255, 255, 255};
  float size_px = 10.0F;  ///< of the marker
  double radius_m = 0.0;  ///< of the sphere
  double priority = 0.0;  ///< where two would overlap, the higher stays; among equals the first
  bool through_surface = false;
};

/// What is drawn over, on and under a planet beside the planet itself. Plain values: thread any.
struct ObjectScene {
  std::vector<PointObject> points = {};
  std::vector<LineObject> lines = {};
  std::vector<PolygonObject> polygons = {};
  std::vector<LabelObject> labels = {};
  [[nodiscard]] bool empty() const { return points.empty() && lines.empty() && polygons.empty() && labels.empty(); }
};

/// An object lies under the ground if any of its places does (height < 0): then the surface is drawn over it.
[[nodiscard]] inline bool is_underground(const Geodetic& place) { return place.height_m < 0.0; }
[[nodiscard]] inline bool is_underground(const std::vector<Geodetic>& places) {
  for (const Geodetic& place : places) {
    if (is_underground(place)) return true;
  }
  return false;
}
[[nodiscard]] inline bool is_underground(const PointObject& point) { return is_underground(point.place); }
[[nodiscard]] inline bool is_underground(const LineObject& line) { return is_underground(line.places); }
[[nodiscard]] inline bool is_underground(const LabelObject& label) { return is_underground(label.place); }
[[nodiscard]] inline bool is_underground(const PolygonObject& polygon) {
  for (const auto& ring : polygon.rings) {
    if (is_underground(ring)) return true;
  }
  return false;
}

}  // namespace terrella
