#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <string>
#include <vector>

#include "geo/coordinates.h"

// thread: any, for all of this header
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

/// A corner of a mesh, in the model's own frame: metres, y up, z forward, x to the left (glTF 2.0).
struct MeshVertex {
  glm::vec3 position_m{0.0F};
  glm::vec3 normal{0.0F};        ///< unit; 0: its triangle's own
  glm::vec2 uv{0.0F};            ///< of the texture, v down
  glm::vec4 color_linear{1.0F};  ///< goes with the part's colour
};

/// A picture for parts of meshes: RGBA8, sRGB, rows from the top.
struct MeshTexture {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> rgba = {};
};

/// Triangles with one material.
struct MeshPart {
  std::vector<MeshVertex> vertices = {};
  std::vector<std::uint32_t> indices = {};  ///< three a triangle, each less than the number of vertices
  glm::vec4 color_linear{1.0F};
  bool translucent = false;  ///< else alpha counts only where it is less than `cutoff`, which is then not drawn
  float cutoff = 0.0F;
  std::shared_ptr<const MeshTexture> texture = {};  ///< none: white
};

struct MeshModel {
  std::vector<MeshPart> parts = {};
};

/// A model that stands at a place, upright there. Those that share a model are drawn together.
struct MeshObject {
  std::shared_ptr<const MeshModel> model = {};
  Geodetic place = {};
  Angle heading = {};  ///< clockwise from north, of the model's forward
  double scale = 1.0;  ///< > 0
  bool through_surface = false;
};

/// What is drawn over, on and under a planet beside the planet itself. Plain values: thread any.
struct ObjectScene {
  std::vector<PointObject> points = {};
  std::vector<LineObject> lines = {};
  std::vector<PolygonObject> polygons = {};
  std::vector<LabelObject> labels = {};
  std::vector<MeshObject> meshes = {};
  [[nodiscard]] bool empty() const {
    return points.empty() && lines.empty() && polygons.empty() && labels.empty() && meshes.empty();
  }
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
[[nodiscard]] inline bool is_underground(const MeshObject& mesh) { return is_underground(mesh.place); }
[[nodiscard]] inline bool is_underground(const PolygonObject& polygon) {
  for (const auto& ring : polygon.rings) {
    if (is_underground(ring)) return true;
  }
  return false;
}

}  // namespace terrella
