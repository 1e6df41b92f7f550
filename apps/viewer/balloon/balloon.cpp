#include "apps/viewer/balloon/balloon.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "apps/viewer/input.h"
#include "apps/viewer/panels/over_globe.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr int kFittingFrames = 2;         // after a change of size
constexpr int kRings = 8;                 // rings of picks around the middle of the picture
constexpr double kRing_px = 6.0;          // from one ring to the next, at 96 dots per inch: less than a marker
constexpr int kPicksInRing = 6;           // more in each ring than in the ring within it
constexpr double kFlyShare = 0.4;         // height after a flight to a place out of view, as after a double click
constexpr double kLeastFlight_m = 100.0;  // over the object
const ImU32 kStem = IM_COL32(232, 240, 248, 160);

/// Draws a line from the balloon to its place, under the panels.
void draw_stem(const UiBox& box, glm::dvec2 at) {
  const glm::dvec2 near(std::clamp(at.x, box.left, box.right), std::clamp(at.y, box.top, box.bottom));
  if (near == at) return;
  ImGui::GetBackgroundDrawList()->AddLine({float(near.x), float(near.y)}, {float(at.x), float(at.y)}, kStem,
                                          line_width(1.5F));
}

}  // namespace

// The nearer of object and ground is what the user sees under the pointer, unless the surface is translucent.
std::optional<Balloon::Chosen> Balloon::find(glm::dvec2 at_px) const {
  const Globe& globe = context_.globe;
  const Viewport size = context_.window.framebuffer();
  GlobePick found = globe.pick(at_px, size);
  auto layer = found.object ? layer_name_(found.objects) : std::nullopt;
  if (!layer) return std::nullopt;
  const View view = globe.view(size);
  const Ground ground = globe.ground();
  Ecef at{view.eye.xyz_m + found.object->distance_m * pixel_ray(view, at_px).xyz};
  if (found.place && globe.options().surface.alpha >= 1.0) {
    const Ecef seen = ground.ellipsoid().to_ecef(*found.place);
    if (glm::distance(seen.xyz_m, view.eye.xyz_m) < found.object->distance_m) at = seen;
  }
  Geodetic place = ground.ellipsoid().to_geodetic(at);
  place.height_m = ground.height_over_m(place);
  return described(found.objects, *std::move(found.object), place, *std::move(layer));
}

Balloon::Chosen Balloon::described(LayerId layer, PickedObject object, const Geodetic& place, std::string layer_name) {
  const auto& feature = object.of.feature;
  ObjectFields fields = object_fields(feature ? feature->properties : std::string());
  std::string title = object_title(object, fields);
  return {layer, std::move(object), place, {std::move(title), std::move(layer_name), std::move(fields.rows)}};
}

// Marker and label of a feature have one id.
bool Balloon::is_chosen(const Chosen& other) const {
  if (!chosen_ || chosen_->layer != other.layer) return false;
  const PickedObject &one = chosen_->object, &two = other.object;
  if (one.of.id != ObjectId::none || two.of.id != ObjectId::none) return one.of.id == two.of.id;
  return one.kind == two.kind && one.index == two.index;
}

// Fails only if the layer was removed meanwhile.
void Balloon::mark(bool selected) const {
  if (!chosen_ || chosen_->object.of.id == ObjectId::none) return;
  ObjectEdits edits;
  edits.changes.push_back({.id = chosen_->object.of.id, .selected = selected});
  (void)context_.globe.edit_objects(chosen_->layer, std::move(edits));
}

void Balloon::choose(std::optional<Chosen> chosen) {
  mark(false);
  chosen_ = std::move(chosen);
  mark(true);
  just_chosen_ = in_view_ = chosen_.has_value();
  with_keyboard_ = keyboard_due_ = false;
  frames_ = kFittingFrames;
  name_.clear();
  pointer_.hush();
}

void Balloon::click(glm::dvec2 at_px) {
  auto found = find(at_px);
  if (found && is_chosen(*found)) found.reset();
  if (found || chosen_) choose(std::move(found));
}

void Balloon::choose(LayerId layer, const ListedFeature& feature) {
  auto name = layer_name_(layer);
  if (!name) return say("The layer is hidden; L shows the layers");
  Geodetic place = feature.place;
  if (feature.heights == HeightMode::absolute) place.height_m = context_.globe.ground().height_over_m(place);
  if (feature.heights == HeightMode::clamp_to_ground) place.height_m = 0.0;
  choose(described(layer, {.kind = feature.kind, .of = feature.of}, place, *std::move(name)));
  if (place_px(context_.globe.view(context_.window.framebuffer()))) return;
  say(chosen_->texts.title + " is not in view: Enter or another click flies there");
}

ObjectId Balloon::chosen_of(LayerId layer) const {
  return chosen_ && chosen_->layer == layer ? chosen_->object.of.id : ObjectId::none;
}

void Balloon::fly_there() const {
  if (!chosen_) return;
  Navigator& navigator = context_.navigator;
  if (const auto at_px = place_px(context_.globe.view(context_.window.framebuffer())))
    return navigator.double_click(*at_px, Input::now());
  Camera over{.eye = chosen_place(), .fov_y = navigator.camera().fov_y};
  const double height_m = kFlyShare * navigator.camera().eye.height_m;
  over.eye.height_m = std::max(over.eye.height_m + kLeastFlight_m, height_m);
  navigator.fly_to(over, Input::now());
  say(chosen_->texts.title);
}

// Arrow keys move far, so objects near the middle count too: the nearest first.
void Balloon::open_in_middle() {
  const double step_px = kRing_px * double(context_.window.text_scale());
  std::optional<Chosen> found;
  for (int ring = 0; ring <= kRings && !found; ++ring) {
    const int count = std::max(1, kPicksInRing * ring);
    for (int k = 0; k < count && !found; ++k) {
      const double turn = 2.0 * std::numbers::pi * k / count;
      found = find(context_.middle_px() + ring * step_px * glm::dvec2(std::cos(turn), std::sin(turn)));
    }
  }
  if (found && is_chosen(*found)) found.reset();
  if (!found && !chosen_) return say("There is no object in the middle of the view");
  const bool opens = found.has_value();
  choose(std::move(found));
  with_keyboard_ = keyboard_due_ = opens;
}

bool Balloon::close() {
  if (!box_) return false;
  choose({});
  return true;
}

bool Balloon::changed() const { return frames_ > 0 || pointer_.is_due(Input::now()) || links_.has_ended(); }

double Balloon::seconds_left(double most_s) const { return pointer_.seconds_left(Input::now(), most_s); }

Geodetic Balloon::chosen_place() const {
  const Ground ground = context_.globe.ground();
  Geodetic place = chosen_->place;
  place.height_m += ground.height_m(place.lat, place.lon);
  return place;
}

/// The place in the picture; nullopt if the place is beside the picture or hidden.
std::optional<glm::dvec2> Balloon::place_px(const View& view) const {
  const Ecef at = context_.globe.options().body.ellipsoid.to_ecef(chosen_place());
  const auto px = project(view, at);
  if (!px || px->x < 0.0 || px->y < 0.0 || px->x > view.viewport.width_px || px->y > view.viewport.height_px) return {};
  return is_hidden(context_.globe, view, at) ? std::nullopt : px;
}

// This frame's message is drawn already.
void Balloon::tell(const std::string& text) {
  say(text);
  frames_ = kFittingFrames;
}

void Balloon::draw_chosen(const View& view, float foot) {
  const auto at_px = place_px(view);
  in_view_ = at_px.has_value();
  if (!at_px) return;
  const glm::dvec2 at = *at_px / context_.window.pixels_per_unit();
  const bool just_chosen = std::exchange(just_chosen_, false);
  const auto wish = draw_balloon(chosen_->texts, at, foot, just_chosen, std::exchange(keyboard_due_, false));
  if (!wish) {
    if (just_chosen) tell(chosen_->texts.title + ": no room for the fields");
    return;
  }
  box_ = wish->box;
  if (context_.globe.options().stereo.mode == Stereo::off) draw_stem(wish->box, at);
  if (wish->fly) fly_there();
  if (!wish->link.empty()) {
    if (const Status opened = links_.open(wish->link); !opened) tell(opened.error().message);
  }
  if (take_panel_closed()) choose({});
}

void Balloon::draw_name(std::optional<glm::dvec2> pointer_px) {
  const Seconds now = Input::now();
  pointer_.follow(context_.globe.objects().empty() ? std::nullopt : pointer_px, now);
  if (const auto at_px = pointer_.take(now)) {
    const auto found = find(*at_px);
    name_ = found && !is_chosen(*found) ? found->texts.title : std::string();
  }
  if (pointer_.is_told() && !name_.empty()) draw_name_at_pointer(name_);
}

void Balloon::draw_over(const View& view, std::optional<glm::dvec2> pointer_px, float foot) {
  for (const std::string& failure : links_.take_failures()) tell(failure);
  if (chosen_ && !layer_name_(chosen_->layer)) choose({});
  frames_ = std::max(0, frames_ - 1);
  const auto last = std::exchange(box_, {});
  if (chosen_) draw_chosen(view, foot);
  if (!box_) with_keyboard_ = false;
  if (box_ && (!last || !last->has_size_of(*box_))) frames_ = kFittingFrames;
  draw_name(pointer_px);
}

}  // namespace terrella
