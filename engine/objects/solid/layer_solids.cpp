#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "objects/layer_objects.h"
#include "objects/object_picker.h"

// The extruded areas of a layer: their triangles, and picks of their walls.
namespace terrella {

void LayerObjects::draw_solid(KeptArea& area) {
  SlotBatch<SolidVertex>& solids = batches_.solids;
  if (area.fill.bucket != fill_bucket(area)) {
    const auto items = solids.at(area.fill);
    const std::vector<SolidVertex> vertices(items.begin(), items.end());
    solids.drop(area.fill);
    area.fill = solids.add(fill_bucket(area), vertices);
  }
  const ObjectColor color = drawn(area.object->fill, area);
  for (SolidVertex& vertex : solids.change(area.fill)) vertex.color = color;
}

// A piece of a wall is a parallelogram: the ray meets it at its upper edge's begin, a part of the edge, and a part of
// the way down.
void ObjectPicker::walls(const PolygonObject& polygon, const PickArea& area, std::size_t index) {
  const PickCone cone(view_, pixel_px_, 0.0);
  const Ellipsoid& e = ground_.ellipsoid();
  const glm::dvec3& eye_m = view_.eye.xyz_m;
  for (const PickWay& way : area.outlines) {
    for (std::size_t run = 0; run < way.runs.size(); ++run) {
      if (!cone.meets(way.runs[run].center_m, way.runs[run].radius_m + area.depth_m)) continue;
      const std::size_t end = std::min((run + 1) * PickWay::kRun, way.places_m.size() - 1);
      for (std::size_t k = run * PickWay::kRun; k < end; ++k) {
        const glm::dvec3 &a_m = way.places_m[k], &b_m = way.places_m[k + 1];
        const Geodetic middle = e.to_geodetic(Ecef{0.5 * (a_m + b_m)});
        const glm::dvec3 up = Ellipsoid::normal(middle.lat, middle.lon).xyz;
        const glm::dvec3 at = glm::inverse(glm::dmat3(ray_, a_m - b_m, area.depth_m * up)) * (a_m - eye_m);
        if (!(at.x > 0.0 && at.y >= 0.0 && at.y <= 1.0 && at.z >= 0.0 && at.z <= 1.0)) continue;
        take(ObjectKind::polygon, index, polygon.of, eye_m + at.x * ray_);
      }
    }
  }
}

}  // namespace terrella
