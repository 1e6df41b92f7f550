#include "scene/object_batches.h"

#include <algorithm>
#include <numeric>

#include "geo/split_position.h"
#include "scene/object_shapes.h"

namespace terrella {
namespace {

template <class T>
using Buckets = std::array<std::vector<T>, Batch<T>::kBuckets>;

template <class T>
Batch<T> joined(Buckets<T>& buckets) {
  Batch<T> batch;
  for (std::size_t k = 0; k < buckets.size(); ++k) {
    batch.first[k] = batch.items.size();
    batch.items.insert(batch.items.end(), buckets[k].begin(), buckets[k].end());
    buckets[k] = {};
  }
  batch.first.back() = batch.items.size();
  return batch;
}

template <class Object>
std::size_t bucket_of(const Object& object, const ObjectColor& color) {
  return Batch<int>::bucket(is_underground(object) ? ObjectPart::underground : ObjectPart::above_ground,
                            color.alpha == 255, object.through_surface);
}

DotInstance dot(const PointObject& point, const Ellipsoid& ellipsoid) {
  const SplitPosition p = split_position(ellipsoid.to_ecef(point.place).xyz_m);
  const float size = point.radius_m > 0.0 ? static_cast<float>(point.radius_m) : point.size_px;
  return {p.high, p.low, size, point.color};
}

void add_points(const ObjectScene& scene, const Ellipsoid& ellipsoid, ObjectBatches& batches) {
  Buckets<DotInstance> spheres, markers;
  for (const PointObject& point : scene.points) {
    auto& buckets = point.radius_m > 0.0 ? spheres : markers;
    buckets[bucket_of(point, point.color)].push_back(dot(point, ellipsoid));
  }
  batches.spheres = joined(spheres);
  batches.markers = joined(markers);
}

/// Appends a line with a vertex before and one behind it; those of a closed one are its neighbours round the corner.
void append_line(const std::vector<glm::dvec3>& way, float width_px, ObjectColor color, bool closed,
                 std::vector<LineVertex>& out) {
  if (way.size() < 2 || width_px <= 0.0F || color.alpha == 0) return;
  const auto vertex = [color](const glm::dvec3& p_m, float width) {
    const SplitPosition p = split_position(p_m);
    return LineVertex{p.high, p.low, width, color};
  };
  out.push_back(vertex(closed ? way[way.size() - 2] : way.front(), 0.0F));
  for (std::size_t k = 0; k + 1 < way.size(); ++k) out.push_back(vertex(way[k], width_px));
  out.push_back(vertex(way.back(), 0.0F));
  out.push_back(vertex(closed ? way[1] : way.back(), 0.0F));
}

Angle step_for(const ObjectScene& scene) {
  double total_rad = 0.0;
  for (const LineObject& line : scene.lines) total_rad += length_of(line.places).rad();
  for (const PolygonObject& polygon : scene.polygons) {
    for (const auto& ring : polygon.rings) total_rad += length_of(ring).rad();
  }
  return std::max(kLineStep, Angle::radians(total_rad / double(kMostLineVertices)));
}

/// Lines, and the outlines of areas, which lie as high as their fills (`lifts_m`, one for each area).
void add_lines(const ObjectScene& scene, const Ellipsoid& ellipsoid, const std::vector<double>& lifts_m,
               ObjectBatches& batches) {
  const Angle step = step_for(scene);
  Buckets<LineVertex> buckets;
  for (const LineObject& line : scene.lines) {
    append_line(line_along_geodesics(line.places, ellipsoid, step), line.width_px, line.color, false,
                buckets[bucket_of(line, line.color)]);
  }
  for (std::size_t k = 0; k < scene.polygons.size(); ++k) {
    const PolygonObject& polygon = scene.polygons[k];
    if (polygon.stroke.alpha == 0) continue;
    const double lift_m = is_underground(polygon) ? 0.0 : std::max(lifts_m[k], sag_m(ellipsoid, step));
    for (const auto& ring : polygon.rings) {
      append_line(outline(ring, ellipsoid, step, lift_m), polygon.stroke_width_px, polygon.stroke, true,
                  buckets[bucket_of(polygon, polygon.stroke)]);
    }
  }
  batches.lines = joined(buckets);
}

/// Areas from the lowest to the highest, so that from above those that are translucent lie over each other as they do
/// in space, whatever their order in the scene; where they lie equally high, that order.
std::vector<std::size_t> by_height(const std::vector<PolygonObject>& polygons) {
  std::vector<double> heights_m;
  heights_m.reserve(polygons.size());
  for (const PolygonObject& polygon : polygons) heights_m.push_back(mean_height_m(polygon));
  std::vector<std::size_t> order(polygons.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&heights_m](std::size_t k) { return heights_m[k]; });
  return order;
}

/// Returns how much each area was lifted.
std::vector<double> add_fills(const ObjectScene& scene, const Ellipsoid& ellipsoid, ObjectBatches& batches) {
  Buckets<std::uint32_t> buckets;
  std::vector<double> lifts_m(scene.polygons.size(), 0.0);
  std::size_t triangles = 0;
  for (const std::size_t k : by_height(scene.polygons)) {
    const PolygonObject& polygon = scene.polygons[k];
    if (polygon.fill.alpha == 0) continue;
    const FillMesh mesh = fill_area(polygon, ellipsoid, kMostFillTriangles - triangles);
    if (mesh.indices.empty()) ++batches.fills_dropped;
    lifts_m[k] = mesh.lift_m;
    triangles += mesh.indices.size() / 3;
    const auto base = static_cast<std::uint32_t>(batches.fill_vertices.size());
    for (const glm::dvec3& p_m : mesh.positions_m) {
      const SplitPosition p = split_position(p_m);
      batches.fill_vertices.push_back({p.high, p.low, polygon.fill});
    }
    auto& indices = buckets[bucket_of(polygon, polygon.fill)];
    for (const std::uint32_t index : mesh.indices) indices.push_back(base + index);
  }
  batches.fill_indices = joined(buckets);
  return lifts_m;
}

}  // namespace

ObjectBatches make_batches(const ObjectScene& scene, const Ellipsoid& ellipsoid) {
  ObjectBatches batches;
  add_points(scene, ellipsoid, batches);
  add_lines(scene, ellipsoid, add_fills(scene, ellipsoid, batches), batches);
  return batches;
}

}  // namespace terrella
