#include "objects/object_batches.h"

#include <algorithm>
#include <numeric>

#include "geo/split_position.h"
#include "objects/object_shapes.h"

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

void add_points(std::span<const CutScene> scenes, const Ellipsoid& ellipsoid, ObjectBatches& batches) {
  Buckets<DotInstance> spheres, markers;
  for (const CutScene& from : scenes) {
    for (const PointObject& point : from.scene.points) {
      auto& buckets = point.radius_m > 0.0 ? spheres : markers;
      buckets[bucket_of(point, point.color)].push_back(dot(point, ellipsoid));
    }
  }
  batches.spheres = joined(spheres);
  batches.markers = joined(markers);
}

/// Appends a line with one vertex before and one after it. For a closed line, these are its neighbours round the
/// corner.
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

/// Appends lines, then the outlines of areas.
void add_lines(std::span<const CutScene> scenes, ObjectBatches& batches) {
  Buckets<LineVertex> buckets;
  for (const auto& [scene, cut] : scenes) {
    for (std::size_t k = 0; k < scene.lines.size(); ++k) {
      const LineObject& line = scene.lines[k];
      append_line(cut.lines[k], line.width_px, line.color, false, buckets[bucket_of(line, line.color)]);
    }
  }
  for (const auto& [scene, cut] : scenes) {
    for (std::size_t k = 0; k < scene.polygons.size(); ++k) {
      const PolygonObject& polygon = scene.polygons[k];
      auto& bucket = buckets[bucket_of(polygon, polygon.stroke)];
      for (const auto& way : cut.outlines[k]) append_line(way, polygon.stroke_width_px, polygon.stroke, true, bucket);
    }
  }
  batches.lines = joined(buckets);
}

struct CutArea {
  const PolygonObject& polygon;
  const FillMesh& fill;
  double height_m;
};

/// Sorts areas from the lowest to the highest, so that translucent areas seen from above are blended in the right
/// order. Areas of equal height keep the order of their scenes.
std::vector<CutArea> by_height(std::span<const CutScene> scenes) {
  std::vector<CutArea> areas;
  for (const auto& [scene, cut] : scenes) {
    for (std::size_t k = 0; k < scene.polygons.size(); ++k) {
      if (scene.polygons[k].fill.alpha == 0) continue;
      areas.push_back({scene.polygons[k], cut.fills[k], cut.heights_m[k]});
    }
  }
  std::vector<std::size_t> order(areas.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&areas](std::size_t k) { return areas[k].height_m; });
  std::vector<CutArea> sorted;
  for (const std::size_t k : order) sorted.push_back(areas[k]);
  return sorted;
}

void add_fills(std::span<const CutScene> scenes, ObjectBatches& batches) {
  Buckets<std::uint32_t> buckets;
  std::size_t triangles = 0;
  for (const auto& [polygon, mesh, height_m] : by_height(scenes)) {
    const std::size_t more = mesh.indices.size() / 3;
    if (more == 0 || more > kMostFillTriangles - triangles) {
      ++batches.fills_dropped;
      continue;
    }
    triangles += more;
    const auto base = static_cast<std::uint32_t>(batches.fill_vertices.size());
    for (const glm::dvec3& p_m : mesh.positions_m) {
      const SplitPosition p = split_position(p_m);
      batches.fill_vertices.push_back({p.high, p.low, polygon.fill});
    }
    auto& indices = buckets[bucket_of(polygon, polygon.fill)];
    for (const std::uint32_t index : mesh.indices) indices.push_back(base + index);
  }
  batches.fill_indices = joined(buckets);
}

}  // namespace

ObjectBatches make_batches(std::span<const CutScene> scenes, const Ellipsoid& ellipsoid) {
  ObjectBatches batches;
  add_points(scenes, ellipsoid, batches);
  add_fills(scenes, batches);
  add_lines(scenes, batches);
  return batches;
}

ObjectBatches make_batches(const ObjectScene& scene, const Ellipsoid& ellipsoid) {
  const CutObjects cut = cut_objects(scene, ellipsoid, line_step(line_length(scene)));
  return make_batches(std::array{CutScene{scene, cut}}, ellipsoid);
}

}  // namespace terrella
