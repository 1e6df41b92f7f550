#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geo/map_plane.h"
#include "objects/object_pick.h"
#include "objects/pick_cone.h"

namespace terrella {

/// A line or an outline as it is picked: places along it, and balls around runs of its pieces.
struct PickWay {
  static constexpr std::size_t kRun = 16;  ///< pieces in a ball
  explicit PickWay(std::vector<glm::dvec3> places);
  std::vector<glm::dvec3> places_m;
  std::vector<Ball> runs;
};

/// An area as it is picked; the roof, if it is extruded.
struct PickArea {
  PickArea(const PolygonObject& polygon, const Ellipsoid& ellipsoid);
  /// True if the fill covers the place: the even-odd rule in the plane in which rings_of() cuts the rings.
  [[nodiscard]] bool covers(const MapPoint& place) const;
  std::vector<PickWay> outlines;
  std::vector<MapRing> rings;
  MapRect box{0.0, 0.0, 0.0, 0.0};
  double height_m;
  double depth_m;  ///< height of the walls under the outlines; 0: no walls
};

/// The rings of an area on the map (rings_of()); none if one is invalid.
[[nodiscard]] std::optional<std::vector<MapRing>> map_rings_of(const PolygonObject& polygon);
/// True if a ring on the map goes an odd number of times past the east of a place.
[[nodiscard]] bool crosses_odd(const MapRing& ring, const MapPoint& place);
[[nodiscard]] PickWay pick_way(const LineObject& line, const Ellipsoid& ellipsoid);
/// True if a point is drawn as an icon.
[[nodiscard]] inline bool is_icon(const PointObject& point) { return point.icon.image && !(point.radius_m > 0.0); }
/// Width and height of an icon on the screen, pixels.
[[nodiscard]] glm::dvec2 icon_sides_px(const PointObject& icon);
/// Distance from a marker's place within which all of the marker lies, pixels.
[[nodiscard]] double reach_px(const PointObject& marker);
/// Distance that an icon reaches down from its place on the screen, at most.
[[nodiscard]] double below_px(const PointObject& icon);
/// Radius of a ball around a model's origin that contains the model, metres at scale 1.
[[nodiscard]] double reach_m(const MeshModel& model);

/// A pick of one pixel: takes objects one after another and keeps the best. thread: as pick_object()
class ObjectPicker {
 public:
  ObjectPicker(const View& view, const Ground& ground, glm::dvec2 pixel_px, const PickOptions& options)
      : view_(view), ground_(ground), pixel_px_(pixel_px), options_(options), ray_(pixel_ray(view, pixel_px).xyz) {}

  void point(const PointObject& point, const glm::dvec3& place_m, std::size_t index);
  void mesh(const MeshObject& mesh, const glm::dvec3& place_m, double radius_m, std::size_t index);
  void line(const LineObject& line, const PickWay& way, std::size_t index);
  void area(const PolygonObject& polygon, const PickArea& area, std::size_t index);
  /// A label whose text covers the pixel.
  void label(const LabelObject& label, const glm::dvec3& place_m, std::size_t index);
  [[nodiscard]] const std::optional<PickedObject>& best() const { return best_; }
  /// Returns a cone around what may be drawn within `reach_px` of the pixel on the ground, if the ground were the
  /// ellipsoid; null if the pixel shows no ground.
  [[nodiscard]] const PickCone* cone_on_ground(double reach_px);

 private:
  void take(ObjectKind kind, std::size_t index, const ObjectIdentity& of, const glm::dvec3& at_m);
  void sphere(ObjectKind kind, std::size_t index, const ObjectIdentity& of, const Ball& ball);
  void along(ObjectKind kind, std::size_t index, const ObjectIdentity& of, const PickWay& way, float width_px);
  [[nodiscard]] bool in_icon(const PointObject& icon, const glm::dvec3& place_m, const glm::dvec2& at_px) const;
  void walls(const PolygonObject& polygon, const PickArea& area, std::size_t index);
  void along_ground(ObjectKind kind, std::size_t index, const ObjectIdentity& of, const PickWay& way, float width_px);
  [[nodiscard]] bool reaches(const glm::dvec3& place_m, double reach_px, glm::dvec3& at_m) const;
  [[nodiscard]] const std::optional<Geodetic>& place();
  [[nodiscard]] bool hidden(const glm::dvec3& at_m) const;

  const View& view_;
  const Ground& ground_;
  glm::dvec2 pixel_px_;
  PickOptions options_;
  glm::dvec3 ray_;
  std::optional<PickedObject> best_;
  bool looked_ = false;            ///< place_ is set
  std::optional<Geodetic> place_;  ///< the ground under the pixel
  std::optional<PickCone> cone_;
};

}  // namespace terrella
