#include "objects/object_pick.h"

#include <glm/geometric.hpp>

#include "objects/ground/on_ground.h"
#include "objects/object_picker.h"

namespace terrella {
namespace {

// Objects on the ground are drawn this fraction of the distance towards the eye, so the ground does not hide them.
constexpr double kGroundShare = 1e-3;

}  // namespace

std::optional<PickedObject> pick_object(const View& view, const Ground& ground, const ObjectScene& scene,
                                        glm::dvec2 pixel_px, const PickOptions& options) {
  ObjectPicker picker(view, ground, pixel_px, options);
  const Ellipsoid& e = ground.ellipsoid();
  for (std::size_t k = 0; k < scene.polygons.size(); ++k) {
    picker.area(scene.polygons[k], PickArea(cut_shape(scene.polygons[k], ground), e), k);
  }
  for (std::size_t k = 0; k < scene.lines.size(); ++k)
    picker.line(scene.lines[k], pick_way(cut_shape(scene.lines[k], ground), e), k);
  for (std::size_t k = 0; k < scene.meshes.size(); ++k) {
    const MeshObject& mesh = scene.meshes[k];
    if (mesh.model)
      picker.mesh(mesh, e.to_ecef(over_ground(mesh.place, mesh.heights, ground)).xyz_m,
                  reach_m(*mesh.model) * mesh.scale, k);
  }
  for (std::size_t k = 0; k < scene.points.size(); ++k) {
    const PointObject& point = scene.points[k];
    picker.point(point, e.to_ecef(over_ground(point.place, point.heights, ground)).xyz_m, k);
  }
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
