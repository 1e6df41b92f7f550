#include <cmath>
#include <glm/geometric.hpp>

#include "geo/longitudes.h"
#include "geo/ranges.h"
#include "globe/globe_impl.h"
#include "surface/daylight.h"

// Picking and projecting: from a pixel to places, layers and objects, and from a place to its pixel.
namespace terrella {
namespace {

bool holds(const TileGrid& grid, const Ellipsoid& ellipsoid, const Geodetic& place) {
  const double row = row_latitude_deg(grid, ellipsoid, Ellipsoid::normal(place.lat, place.lon));
  if (row < grid.bounds.south.deg() || row > grid.bounds.north.deg()) return false;
  return meets_longitudes(grid.bounds, place.lon.deg(), 0.0);
}

}  // namespace

bool GlobeView::Impl::shows(const ImageLayer& layer, const Geodetic& place) const {
  const bool has_night = globe->has_night();
  if (!layer.is_drawn(globe->sides()) || !holds(layer.grid(), globe->options.body.ellipsoid, place)) return false;
  if (!has_night) return true;
  const double sun_sine = glm::dot(Ellipsoid::normal(place.lat, place.lon).xyz, sun());
  return part_shown(layer.look().daylight, sun_sine) > 0.0;
}

View GlobeView::Impl::eye_view(Viewport viewport) const {
  return make_view(camera, globe != nullptr ? globe->options.body.ellipsoid : earth().ellipsoid, viewport);
}

View GlobeView::Impl::eye_view(const char* call, Viewport viewport) const {
  return on_thread(call) ? eye_view(viewport) : make_view(Camera{}, earth().ellipsoid, Viewport{});
}

GlobePick GlobeView::Impl::pick(glm::dvec2 pixel_px, Viewport viewport) const {
  GlobePick found;
  if (!check_viewport(viewport) || !std::isfinite(pixel_px.x + pixel_px.y)) return found;
  const View eye = eye_view(viewport);
  const Ground drawn_ground = globe->ground();
  found.place = terrella::pick(eye, drawn_ground, pixel_px);
  for (const auto& layer : globe->images) {
    const bool on_side = shows_at(layer->look().swipe, globe->options.surface.swipe, pixel_px.x, viewport.width_px);
    if (found.place && on_side && shows(*layer, *found.place)) found.imagery = layer->id();
  }
  const PickOptions how{.through_ground = globe->options.surface.alpha < 1.0};
  for (const ObjectLayer& layer : globe->objects) {
    if (!layer.is_drawn()) continue;
    LayerObjects& objects = *layer.drawn().objects;
    const auto object = objects.pick(eye, drawn_ground, pixel_px, how, memory.labels.at(objects, pixel_px, viewport));
    if (!object || (found.object && found.object->distance_m < object->distance_m)) continue;
    found.object = object;
    found.objects = layer.id;
  }
  return found;
}

Result<std::optional<LayerValue>> Globe::value_at(LayerId imagery, const Geodetic& place) const {
  const auto call = impl_->may_draw("Globe::value_at");
  if (!call) return call.error();
  if (const Status good = check_place(place); !good) return refusal("Globe::value_at", good);
  const ImageLayer* layer = impl_->image(imagery);
  if (layer == nullptr || !layer->has_numbers()) return no_layer("Globe::value_at", "layer of numbers", imagery);
  return layer->value_at(place);
}

std::future<Result<double, TileFailure>> Globe::stored_value(LayerId imagery, const Geodetic& place) const {
  const ImageLayer* layer = impl_->may_call("Globe::stored_value") ? impl_->image(imagery) : nullptr;
  const Status good = check_place(place);
  if (layer == nullptr || !good) {
    std::promise<Result<double, TileFailure>> none;
    none.set_value(TileFailure{MissingKind::absent, good ? "the globe has no such image layer" : good.error().message});
    return none.get_future();
  }
  return std::async(std::launch::async, [source = layer->source(), place, figure = impl_->options.body.ellipsoid] {
    return source->value_at(place, figure);
  });
}

std::optional<glm::dvec2> GlobeView::Impl::project(const Geodetic& place, Viewport viewport) const {
  if (!check_viewport(viewport) || !check_place(place)) return std::nullopt;
  const View eye = eye_view(viewport);
  const Ecef at = globe->options.body.ellipsoid.to_ecef(place);
  const auto pixel = terrella::project(eye, at);
  if (!pixel || pixel->x < 0.0 || pixel->y < 0.0 || pixel->x > viewport.width_px || pixel->y > viewport.height_px) {
    return std::nullopt;
  }
  return hidden_by_ground(eye, globe->ground(), at) ? std::nullopt : pixel;
}

Ground Globe::ground() const { return impl_->may_call("Globe::ground") ? impl_->ground() : earth().ellipsoid; }

double Globe::ground_height_m(Angle lat, Angle lon) const {
  const bool may = impl_->may_call("Globe::ground_height_m") && check_place({lat, lon});
  return may ? impl_->ground().height_m(lat, lon) : 0.0;
}

std::optional<double> Globe::elevation_m(Angle lat, Angle lon) const {
  if (!impl_->may_call("Globe::elevation_m") || !impl_->heights || !check_place({lat, lon})) return std::nullopt;
  return impl_->relief()->field().height_m(lat, lon);
}

}  // namespace terrella
