#include <cmath>

#include "engine/globe_impl.h"

// What is under a pixel.
namespace terrella {
namespace {

bool holds(const TileGrid& grid, const Ellipsoid& ellipsoid, const Geodetic& place) {
  const double row = row_latitude_deg(grid, ellipsoid, Ellipsoid::normal(place.lat, place.lon));
  if (row < grid.bounds.south.deg() || row > grid.bounds.north.deg()) return false;
  const double west = grid.bounds.west.deg(), lon = place.lon.deg();
  const double width = grid.bounds.east.deg() - west, turn = width < 0.0 ? width + 360.0 : width;
  return turn >= 360.0 || lon - west - 360.0 * std::floor((lon - west) / 360.0) <= turn;
}

}  // namespace

GlobePick Globe::Impl::pick(const View& eye, glm::dvec2 pixel_px) const {
  GlobePick found;
  found.place = terrella::pick(eye, ground(), pixel_px);
  for (const auto& layer : images) {
    if (found.place && layer->is_drawn() && holds(layer->grid(), options.body.ellipsoid, *found.place)) {
      found.imagery = layer->id();
    }
  }
  const PickOptions how{.through_ground = options.surface.alpha < 1.0};
  for (const ObjectLayer& layer : objects) {
    if (!layer.shown) continue;
    const auto object = pick_object(eye, ground(), layer.scene, pixel_px, how);
    if (!object || (found.object && found.object->distance_m < object->distance_m)) continue;
    found.object = object;
    found.objects = layer.id;
  }
  return found;
}

}  // namespace terrella
