#include <algorithm>
#include <cmath>
#include <vector>

#include "apps/open_scene/bounds_view.h"

namespace terrella {
namespace {

std::vector<Geodetic> places_of(const ObjectScene& scene) {
  std::vector<Geodetic> places;
  for (const PointObject& point : scene.points) places.push_back(point.place);
  for (const LabelObject& label : scene.labels) places.push_back(label.place);
  for (const MeshObject& mesh : scene.meshes) places.push_back(mesh.place);
  for (const LineObject& line : scene.lines) places.insert(places.end(), line.places.begin(), line.places.end());
  for (const PolygonObject& polygon : scene.polygons) {
    for (const auto& ring : polygon.rings) places.insert(places.end(), ring.begin(), ring.end());
  }
  return places;
}

double wrapped_deg(double lon_deg) { return lon_deg - 360.0 * std::floor((lon_deg + 180.0) / 360.0); }

}  // namespace

// Leaves out the widest gap between neighbours along the parallel.
std::optional<GeoRect> bounds_of(const ObjectScene& scene) {
  const std::vector<Geodetic> places = places_of(scene);
  if (places.empty()) return {};
  std::vector<double> lons_deg;
  double south_deg = 90.0, north_deg = -90.0;
  for (const Geodetic& place : places) {
    lons_deg.push_back(wrapped_deg(place.lon.deg()));
    south_deg = std::min(south_deg, place.lat.deg());
    north_deg = std::max(north_deg, place.lat.deg());
  }
  std::ranges::sort(lons_deg);
  double west_deg = lons_deg.front(), east_deg = lons_deg.back(), widest_deg = 360.0 - (east_deg - west_deg);
  for (std::size_t i = 1; i < lons_deg.size(); ++i) {
    const double gap_deg = lons_deg[i] - lons_deg[i - 1];
    if (gap_deg <= widest_deg) continue;
    widest_deg = gap_deg;
    west_deg = lons_deg[i];
    east_deg = lons_deg[i - 1];
  }
  return if_a_part({.west = Angle::degrees(west_deg),
                    .south = Angle::degrees(south_deg),
                    .east = Angle::degrees(east_deg),
                    .north = Angle::degrees(north_deg)});
}

}  // namespace terrella
