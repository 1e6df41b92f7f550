#include <glm/geometric.hpp>

#include "geo/longitudes.h"
#include "globe/globe_impl.h"
#include "surface/daylight.h"

// Picking: the place, layer and object under a pixel.
namespace terrella {
namespace {

bool holds(const TileGrid& grid, const Ellipsoid& ellipsoid, const Geodetic& place) {
  const double row = row_latitude_deg(grid, ellipsoid, Ellipsoid::normal(place.lat, place.lon));
  if (row < grid.bounds.south.deg() || row > grid.bounds.north.deg()) return false;
  return meets_longitudes(grid.bounds, place.lon.deg(), 0.0);
}

}  // namespace

bool Globe::Impl::shows(const ImageLayer& layer, const Geodetic& place) const {
  if (!layer.is_drawn(has_night()) || !holds(layer.grid(), options.body.ellipsoid, place)) return false;
  if (!has_night()) return true;
  const double sun_sine = glm::dot(Ellipsoid::normal(place.lat, place.lon).xyz, sun());
  return part_shown(layer.look().daylight, sun_sine) > 0.0;
}

GlobePick Globe::Impl::pick(const View& eye, glm::dvec2 pixel_px) const {
  GlobePick found;
  found.place = terrella::pick(eye, ground(), pixel_px);
  for (const auto& layer : images) {
    if (found.place && shows(*layer, *found.place)) found.imagery = layer->id();
  }
  const PickOptions how{.through_ground = options.surface.alpha < 1.0};
  for (const ObjectLayer& layer : objects) {
    if (!layer.is_drawn()) continue;
    const auto object = pick_object(eye, ground(), layer.scene, pixel_px, how);
    if (!object || (found.object && found.object->distance_m < object->distance_m)) continue;
    found.object = object;
    found.objects = layer.id;
  }
  return found;
}

}  // namespace terrella
