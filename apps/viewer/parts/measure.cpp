#include "apps/viewer/parts/measure.h"

#include <utility>

namespace terrella {

void Measure::toggle() {
  on_ = !on_;
  places_.clear();
  show();
}

bool Measure::close() {
  if (!on_) return false;
  toggle();
  return true;
}

void Measure::add(glm::dvec2 at_px) {
  if (!on_) return;
  const Globe& globe = context_.globe;
  auto place = pick(globe.view(context_.window.framebuffer()), globe.ground(), at_px);
  if (!place) return say("There is no ground to measure from");
  if (!globe.has_relief()) place->height_m = 0.0;  // rounding could put the place under the ground
  places_.add(*place);
  show();
}

void Measure::take_back() {
  places_.take_back();
  show();
}

std::string Measure::text() const { return on_ ? places_.text(context_.globe.options().body.ellipsoid) : ""; }

void Measure::show() {
  Globe& globe = context_.globe;
  ObjectScene scene = places_.scene(globe.options().body.ellipsoid, context_.window.text_scale());
  Status shown = Done{};
  if (layer_) {
    shown = globe.set_objects(*layer_, std::move(scene));
  } else if (!scene.empty()) {
    const Result<LayerId> layer = globe.add_objects(std::move(scene));
    if (layer) layer_ = *layer;
    if (!layer) shown = layer.error();
  }
  if (!shown) say(shown.error().message);
}

}  // namespace terrella
