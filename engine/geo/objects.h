#pragma once

#include <array>
#include <cstddef>
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

/// A displayed colour, sRGB, 0 to 255; alpha 255 is opaque.
struct ObjectColor {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  std::uint8_t alpha = 255;
  bool operator==(const ObjectColor&) const = default;
};

/// The name of a feature within its object layer, chosen by the application. Objects with the same id are parts of one
/// feature, such as a marker and its label: an edit of the id (geo/object_edits.h) changes them together.
enum class ObjectId : std::uint64_t { none = 0 };

/// Data of a feature that the globe keeps and does not draw. A pick returns it.
struct ObjectFeature {
  std::string properties = {};  ///< JSON text, such as the properties of a GeoJSON feature
  std::uint64_t user = 0;       ///< a value of the application
};

/// The feature that an object is a part of. Every object has one.
struct ObjectIdentity {
  ObjectId id = ObjectId::none;  ///< none: the object cannot be edited by itself
  std::shared_ptr<const ObjectFeature> feature = {};
};

/// A picture for points: RGBA8, sRGB, not premultiplied, first row at the top. A side has 1 to kMostIconSide_px pixels.
struct IconImage {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> rgba = {};  ///< width · height · 4 bytes
};
inline constexpr int kMostIconSide_px = 256;
/// Most pictures in an object layer. Points that share an IconImage count as one.
inline constexpr std::size_t kMostIcons = 512;

/// A picture that a point shows in place of a disc, and the way it lies.
struct PointIcon {
  std::shared_ptr<const IconImage> image = {};  ///< empty: a disc is drawn
  glm::vec2 anchor{0.5F, 0.5F};                 ///< the part of width and height at the place, from the upper left
  Angle heading = {};                           ///< direction of the picture's upper edge, clockwise
  bool from_north = false;  ///< `heading` counts from north at the place; else from the upper edge of the screen
  ObjectColor tint{255, 255, 255};  ///< factor of the picture's colours and alpha
};

/// Meaning of an object's heights. The ground is the drawn one: exaggerated, from the heights that are loaded. Objects
/// follow it when heights arrive, without a call.
enum class HeightMode {
  absolute,            ///< metres over the ellipsoid
  clamp_to_ground,     ///< unused: points stand on the ground, lines and flat areas lie on it as if painted
  relative_to_ground,  ///< metres over the ground under each place
};

// Globe::add_objects() refuses objects with a value out of its range. Places are those of check_place(), sizes are from
// 0 to 1e6 px, radii and lengths at most 1e12 m.

/// A point, drawn as a sphere with a radius in metres, or as a disc or an icon of constant size on the screen.
struct PointObject {
  Geodetic place = {};
  double radius_m = 0.0;           ///< not negative; > 0: a sphere around `place`; 0: a marker of `size_px`
  float size_px = 10.0F;           ///< diameter of a disc, the longer side of an icon, then positive
  ObjectColor color{230, 60, 50};  ///< colour of a sphere or a disc
  PointIcon icon = {};             ///< icon of a marker
  bool through_surface = false;    ///< visible from below through a surface that is translucent for selected objects
  ObjectIdentity of = {};
  HeightMode heights = HeightMode::absolute;
};

/// The dashes of a line: lengths along it, pixels from 0 to 1,000, both over 0 or both 0. They keep their place on the
/// ground while the view moves, and have twice or half their length on the ground when it comes nearer or goes away. So
/// where the ground is seen from above they have 0.5 to 2 times their length, mostly 0.7 to 1.4 times.
struct LineDashes {
  float on_px = 0.0F, off_px = 0.0F;  ///< 0: the line has no gaps
  bool operator==(const LineDashes&) const = default;
};

/// A line through places, along geodesics of the ellipsoid. The height changes evenly between two places.
struct LineObject {
  std::vector<Geodetic> places = {};
  float width_px = 2.0F;
  ObjectColor color{230, 60, 50};
  bool through_surface = false;
  ObjectIdentity of = {};
  HeightMode heights = HeightMode::absolute;
  LineDashes dashes = {};
  float casing_px = 0.0F;                             ///< width of a border on each side, without gaps
  ObjectColor casing{255, 255, 255};                  ///< colour of the border
  bool arrow_at_start = false, arrow_at_end = false;  ///< arrow heads, in the line's colour
};

/// An area with holes: all that an odd number of rings encloses. geo/great_circle.h defines edges, ±180° and poles. The
/// fill lies at one height, the mean height of the places. The stroke follows the height of each place.
///
/// An extruded area is a body: a roof, `extrude_m` over the fill's height, and vertical walls under it, both lit, in
/// the colour of the fill. The stroke goes round the roof. Walls begin at the fill's height. With the other height
/// modes they begin at the lowest ground under the edges, and the roof counts from the mean ground under the places.
struct PolygonObject {
  std::vector<std::vector<Geodetic>> rings = {};  ///< the last place of a ring may repeat its first
  ObjectColor fill{230, 60, 50, 90};              ///< alpha 0: no fill
  ObjectColor stroke{230, 60, 50};                ///< alpha 0: no stroke
  float stroke_width_px = 2.0F;
  bool through_surface = false;
  ObjectIdentity of = {};
  HeightMode heights = HeightMode::absolute;
  double extrude_m = 0.0;  ///< height of the walls, metres; not over 0: a flat area
};

/// The part of a label's text that is at the marker, in the words of MapLibre's text-anchor. A text that is `left`
/// stands right of the marker, `top` below it, and `center` lies over it.
enum class TextAnchor : std::uint8_t {
  center,
  left,
  right,
  top,
  bottom,
  top_left,
  top_right,
  bottom_left,
  bottom_right,
};
/// Returns the part of a text's width and height that an anchor names, from the upper left.
[[nodiscard]] inline glm::vec2 part_at(TextAnchor anchor) {
  constexpr std::array<glm::vec2, 9> kParts{{{0.5F, 0.5F},
                                             {0.0F, 0.5F},
                                             {1.0F, 0.5F},
                                             {0.5F, 0.0F},
                                             {0.5F, 1.0F},
                                             {0.0F, 0.0F},
                                             {1.0F, 0.0F},
                                             {0.0F, 1.0F},
                                             {1.0F, 1.0F}}};
  return kParts[static_cast<std::size_t>(anchor)];
}

inline constexpr float kLeastText_px = 6.0F, kMostText_px = 64.0F, kMostHalo_px = 8.0F;

/// Thickness of the strokes of letters. All fonts have all weights, because strokes are made thicker or thinner.
enum class TextWeight : std::uint8_t { light, regular, bold };

/// The look of a label's text beside its colour.
struct LabelLook {
  float text_px = 15.0F;           ///< size of the font, kLeastText_px to kMostText_px; drawn at whole pixels
  ObjectColor halo{0, 0, 0, 179};  ///< colour around the letters
  float halo_px = 1.4F;            ///< reach of the halo past the letters, 0 (none) to kMostHalo_px; in 0.2 px steps
  TextAnchor anchor = TextAnchor::left;  ///< near the limb of a globe, texts beside a marker turn to its other side
  float letter_spacing_em = 0.0F;        ///< 0 to 1 of the font's size; scripts with joined letters keep 0
  TextWeight weight = TextWeight::regular;
  bool slanted = false;       ///< letters lean to the right, as names of waters do on maps
  float halo_blur_px = 0.0F;  ///< the halo fades over this width at its outer end, 0 to kMostHalo_px; in 0.2 px steps
  bool operator==(const LabelLook&) const = default;
};

/// A text, UTF-8, beside the marker or sphere at a place.
struct LabelObject {
  std::string text = {};
  Geodetic place = {};
  ObjectColor color{255, 255, 255};
  float size_px = 10.0F;  ///< size of the marker
  double radius_m = 0.0;  ///< radius of the sphere
  /// If two labels would overlap, only the label with the higher priority is shown; on a tie, the first.
  double priority = 0.0;  ///< not NaN
  bool through_surface = false;
  ObjectIdentity of = {};
  HeightMode heights = HeightMode::absolute;
  LabelLook look = {};
};

/// A vertex of a mesh in the frame of the model: metres, y up, z forward, x to the left (glTF 2.0). All finite.
struct MeshVertex {
  glm::vec3 position_m{0.0F};
  glm::vec3 normal{0.0F};        ///< unit; 0: use the normal of the triangle
  glm::vec2 uv{0.0F};            ///< texture coordinates, v down
  glm::vec4 color_linear{1.0F};  ///< multiplied by the colour of the part
};

/// A texture of mesh parts: RGBA8, sRGB, first row at the top.
struct MeshTexture {
  int width_px = 0, height_px = 0;      ///< positive
  std::vector<std::uint8_t> rgba = {};  ///< width · height · 4 bytes
};

/// Triangles with one material.
struct MeshPart {
  std::vector<MeshVertex> vertices = {};
  std::vector<std::uint32_t> indices = {};  ///< three per triangle, each less than the number of vertices
  glm::vec4 color_linear{1.0F};
  /// False: drawn opaque, but texels with alpha below `cutoff` are not drawn.
  bool translucent = false;
  float cutoff = 0.0F;
  std::shared_ptr<const MeshTexture> texture = {};  ///< empty: white
};

struct MeshModel {
  std::vector<MeshPart> parts = {};
};

/// A model that stands upright at a place. Objects that share a model are drawn together.
struct MeshObject {
  std::shared_ptr<const MeshModel> model = {};  ///< never null
  Geodetic place = {};
  Angle heading = {};  ///< direction of the model's forward axis, clockwise from north
  double scale = 1.0;  ///< > 0
  bool through_surface = false;
  ObjectIdentity of = {};
  HeightMode heights = HeightMode::absolute;
};

/// All objects of a scene: over, on and under the ground. A plain value. thread: any
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

/// True if a line or an area lies on the ground as if it were painted there. An extruded area stands on the ground.
[[nodiscard]] inline bool is_draped(const LineObject& line) { return line.heights == HeightMode::clamp_to_ground; }
[[nodiscard]] inline bool is_extruded(const PolygonObject& polygon) { return polygon.extrude_m > 0.0; }
[[nodiscard]] inline bool is_draped(const PolygonObject& polygon) {
  return polygon.heights == HeightMode::clamp_to_ground && !is_extruded(polygon);
}

/// True if a line has a border.
[[nodiscard]] inline bool has_casing(const LineObject& line) {
  return line.casing_px > 0.0F && line.casing.alpha > 0 && line.width_px > 0.0F;
}

/// True if any place of the object lies under the ground (height < 0). The surface is then drawn over the object. An
/// object that is clamped to the ground does not lie under it.
[[nodiscard]] inline bool is_underground(const Geodetic& place) { return place.height_m < 0.0; }
[[nodiscard]] inline bool is_underground(const std::vector<Geodetic>& places) {
  for (const Geodetic& place : places) {
    if (is_underground(place)) return true;
  }
  return false;
}
[[nodiscard]] inline bool is_underground(const PointObject& point) {
  return point.heights != HeightMode::clamp_to_ground && is_underground(point.place);
}
[[nodiscard]] inline bool is_underground(const LineObject& line) {
  return line.heights != HeightMode::clamp_to_ground && is_underground(line.places);
}
[[nodiscard]] inline bool is_underground(const LabelObject& label) {
  return label.heights != HeightMode::clamp_to_ground && is_underground(label.place);
}
[[nodiscard]] inline bool is_underground(const MeshObject& mesh) {
  return mesh.heights != HeightMode::clamp_to_ground && is_underground(mesh.place);
}
[[nodiscard]] inline bool is_underground(const PolygonObject& polygon) {
  if (polygon.heights == HeightMode::clamp_to_ground) return false;
  for (const auto& ring : polygon.rings) {
    if (is_underground(ring)) return true;
  }
  return false;
}

}  // namespace terrella
