#include "objects/cut_objects.h"

#include <algorithm>
#include <numeric>

namespace terrella {
namespace {

/// Areas get their triangles from the lowest to the highest. If there are too many triangles, the highest areas are
/// left out.
void cut_fills(const ObjectScene& scene, const Ellipsoid& ellipsoid, CutObjects& cut) {
  for (const PolygonObject& polygon : scene.polygons) cut.heights_m.push_back(mean_height_m(polygon));
  std::vector<std::size_t> order(scene.polygons.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&cut](std::size_t k) { return cut.heights_m[k]; });
  cut.fills.resize(scene.polygons.size());
  std::size_t triangles = 0;
  for (const std::size_t k : order) {
    if (scene.polygons[k].fill.alpha == 0) continue;
    cut.fills[k] = fill_area(scene.polygons[k], ellipsoid, kMostFillTriangles - triangles);
    triangles += cut.fills[k].indices.size() / 3;
  }
}

/// Outlines lie at the height of the fills.
void cut_outlines(const ObjectScene& scene, const Ellipsoid& ellipsoid, CutObjects& cut) {
  cut.outlines.resize(scene.polygons.size());
  for (std::size_t k = 0; k < scene.polygons.size(); ++k) {
    const PolygonObject& polygon = scene.polygons[k];
    if (polygon.stroke.alpha == 0) continue;
    const double lift_m = is_underground(polygon) ? 0.0 : std::max(cut.fills[k].lift_m, sag_m(ellipsoid, cut.step));
    for (const auto& ring : polygon.rings) cut.outlines[k].push_back(outline(ring, ellipsoid, cut.step, lift_m));
  }
}

}  // namespace

Angle line_length(const ObjectScene& scene) {
  Angle length{};
  for (const LineObject& line : scene.lines) length = length + length_of(line.places);
  for (const PolygonObject& polygon : scene.polygons) {
    for (const auto& ring : polygon.rings) length = length + length_of(ring);
  }
  return length;
}

Angle line_step(Angle length) {
  Angle step = kLineStep;
  while (length.rad() > double(kMostLineVertices) * step.rad()) step = 2.0 * step;
  return step;
}

CutObjects cut_objects(const ObjectScene& scene, const Ellipsoid& ellipsoid, Angle step) {
  CutObjects cut;
  cut.step = step;
  for (const LineObject& line : scene.lines) {
    cut.lines.push_back(line.color.alpha == 0 ? CutObjects::Way{} : line_along_geodesics(line.places, ellipsoid, step));
  }
  cut_fills(scene, ellipsoid, cut);
  cut_outlines(scene, ellipsoid, cut);
  return cut;
}

}  // namespace terrella
