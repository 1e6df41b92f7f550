#include "objects/object_pick.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "geo/great_circle.h"
#include "objects/object_shapes.h"

namespace terrella {
namespace {

// Objects on the ground are drawn this fraction of the distance towards the eye, so the ground does not hide them.
constexpr double kGroundShare = 1e-3;
// Distances that differ by at most this fraction count as equal.
constexpr double kSameDistance = 0.01;
constexpr double kMostPickPieces = 2048.0;

class ObjectPicker {
 public:
  ObjectPicker(const View& view, const Ground& ground, glm::dvec2 pixel_px, const PickOptions& options)
      : view_(view), ground_(ground), pixel_px_(pixel_px), options_(options), ray_(pixel_ray(view, pixel_px).xyz) {}

  void pick(const ObjectScene& scene) {
    for (std::size_t k = 0; k < scene.polygons.size(); ++k) polygon(scene.polygons[k], k);
    for (std::size_t k = 0; k < scene.lines.size(); ++k) line(scene.lines[k], k);
    for (std::size_t k = 0; k < scene.meshes.size(); ++k) mesh(scene.meshes[k], k);
    for (std::size_t k = 0; k < scene.points.size(); ++k) point(scene.points[k], k);
  }
  [[nodiscard]] const std::optional<PickedObject>& best() const { return best_; }

 private:
  // At equal distance, a later object wins.
  void take(ObjectKind kind, std::size_t index, const glm::dvec3& at_m) {
    const double distance = glm::length(at_m - view_.eye.xyz_m);
    if (best_ && distance > best_->distance_m * (1.0 + kSameDistance)) return;
    if (hidden(at_m)) return;
    best_ = PickedObject{kind, index, distance};
  }

  // The far side begins beyond the point of the line of sight that is nearest to the centre.
  [[nodiscard]] bool hidden(const glm::dvec3& at_m) const {
    if (!options_.through_ground) return hidden_by_ground(view_, ground_, Ecef{at_m});
    const glm::dvec3 way = at_m - view_.eye.xyz_m;
    return glm::dot(at_m, way) > 0.0 && hidden_by_ground(view_, Ground(ground_.ellipsoid()), Ecef{at_m});
  }

  void sphere(ObjectKind kind, std::size_t index, const glm::dvec3& center_m, double radius_m) {
    const glm::dvec3 to_center = center_m - view_.eye.xyz_m;
    const double along = glm::dot(to_center, ray_);
    const double beside2 = glm::dot(to_center, to_center) - along * along;
    if (along <= 0.0 || beside2 > radius_m * radius_m) return;
    take(kind, index, view_.eye.xyz_m + ray_ * (along - std::sqrt(radius_m * radius_m - beside2)));
  }

  void point(const PointObject& point, std::size_t index) {
    const Ecef place = ground_.ellipsoid().to_ecef(point.place);
    if (point.radius_m > 0.0) return sphere(ObjectKind::point, index, place.xyz_m, point.radius_m);
    const auto at = project(view_, place);
    if (!at || glm::length(*at - pixel_px_) > 0.5 * double(point.size_px) + options_.slack_px) return;
    take(ObjectKind::point, index, place.xyz_m);
  }

  void mesh(const MeshObject& mesh, std::size_t index) {
    if (!mesh.model) return;
    float reach_m = 0.0F;
    for (const MeshPart& part : mesh.model->parts) {
      for (const MeshVertex& vertex : part.vertices) reach_m = std::max(reach_m, glm::length(vertex.position_m));
    }
    sphere(ObjectKind::mesh, index, ground_.ellipsoid().to_ecef(mesh.place).xyz_m, double(reach_m) * mesh.scale);
  }

  void line(const LineObject& line, std::size_t index) {
    const Angle step = std::max(kLineStep, Angle::radians(length_of(line.places).rad() / kMostPickPieces));
    way(ObjectKind::line, index, line_along_geodesics(line.places, ground_.ellipsoid(), step), line.width_px);
  }

  void way(ObjectKind kind, std::size_t index, const std::vector<glm::dvec3>& way_m, float width_px) {
    const double reach_px = 0.5 * double(width_px) + options_.slack_px;
    for (std::size_t k = 1; k < way_m.size(); ++k) {
      const auto a = project(view_, Ecef{way_m[k - 1]}), b = project(view_, Ecef{way_m[k]});
      if (!a || !b) continue;
      const glm::dvec2 side = *b - *a;
      const double part = std::clamp(glm::dot(pixel_px_ - *a, side) / std::max(glm::dot(side, side), 1e-12), 0.0, 1.0);
      if (glm::length(*a + part * side - pixel_px_) > reach_px) continue;
      take(kind, index, way_m[k - 1] + part * (way_m[k] - way_m[k - 1]));
    }
  }

  // The fill lies at one height, so the ray is intersected with the body raised by that height.
  void polygon(const PolygonObject& polygon, std::size_t index) {
    if (polygon.stroke.alpha > 0) {
      for (const auto& ring : polygon.rings) {
        const Angle step = std::max(kLineStep, Angle::radians(length_of(ring).rad() / kMostPickPieces));
        way(ObjectKind::polygon, index, outline(ring, ground_.ellipsoid(), step, 0.0), polygon.stroke_width_px);
      }
    }
    if (polygon.fill.alpha == 0) return;
    const double height_m = mean_height_m(polygon);
    const Ellipsoid& e = ground_.ellipsoid();
    const double a_m = e.a_m() + height_m, b_m = e.b_m() + height_m;
    const auto distance = Ellipsoid(a_m, 1.0 - b_m / a_m).intersect_m(view_.eye, EcefDir{ray_});
    if (!distance) return;
    const glm::dvec3 at_m = view_.eye.xyz_m + *distance * ray_;
    const Geodetic place = e.to_geodetic(Ecef{at_m});
    if (inside(polygon, {place.lon.deg(), place.lat.deg()})) take(ObjectKind::polygon, index, at_m);
  }

  // Even-odd test in the plane in which rings_of() cuts the rings.
  static bool inside(const PolygonObject& polygon, const MapPoint& p) {
    bool in = false;
    for (const auto& ring : polygon.rings) {
      std::vector<MapPoint> positions;
      positions.reserve(ring.size());
      for (const Geodetic& place : ring) positions.push_back({place.lon.deg(), place.lat.deg()});
      const Result<std::vector<MapRing>> rings = rings_of(positions);
      if (!rings) return false;
      for (const MapRing& closed : *rings) in = in != crossed(closed, p);
    }
    return in;
  }
  static bool crossed(const MapRing& ring, const MapPoint& p) {
    bool odd = false;
    for (std::size_t k = 0, before = ring.size() - 1; k < ring.size(); before = k++) {
      const MapPoint &a = ring[before], &b = ring[k];
      if ((a.lat_deg > p.lat_deg) == (b.lat_deg > p.lat_deg)) continue;
      const double lon = a.lon_deg + (p.lat_deg - a.lat_deg) / (b.lat_deg - a.lat_deg) * (b.lon_deg - a.lon_deg);
      if (p.lon_deg < lon) odd = !odd;
    }
    return odd;
  }

  const View& view_;
  const Ground& ground_;
  glm::dvec2 pixel_px_;
  const PickOptions& options_;
  glm::dvec3 ray_;
  std::optional<PickedObject> best_;
};

}  // namespace

std::optional<PickedObject> pick_object(const View& view, const Ground& ground, const ObjectScene& scene,
                                        glm::dvec2 pixel_px, const PickOptions& options) {
  ObjectPicker picker(view, ground, pixel_px, options);
  picker.pick(scene);
  return picker.best();
}

bool hidden_by_ground(const View& view, const Ground& ground, const Ecef& place) {
  const glm::dvec3 way = place.xyz_m - view.eye.xyz_m;
  const double distance_m = glm::length(way);
  if (distance_m <= 0.0) return false;
  const auto ground_m = ground.intersect_m(view.eye, EcefDir{way / distance_m}, 1.0 / view.pixels_per_radian());
  return ground_m && *ground_m < distance_m * (1.0 - kGroundShare);
}

}  // namespace terrella
