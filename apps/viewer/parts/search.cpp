#include "apps/viewer/parts/search.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "apps/process/data_dir.h"
#include "apps/viewer/input.h"
#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/panel_items.h"
#include "apps/viewer/panels/readout.h"
#include "geo/body.h"
#include "geo/place_text.h"

namespace terrella {
namespace {

constexpr double kPlaceHeight = 0.05;   // height above a found place, in radii
constexpr double kCountryHeight = 1.5;  // height above a country, in sides of a square of its area: it fills the window
constexpr float kMark_px = 12.0F;
constexpr std::size_t kMostFound = 8;
constexpr double kCoordinateStep_deg = 1e-4;  // last digit of coordinates in the list
constexpr float kSearchWidth = 22.0F;         // in text heights

std::string full_name(const NamedPlace& place) {
  return place.country.empty() ? place.name : place.name + ", " + place.country;
}

}  // namespace

bool Search::can_open() {
  if (!places_) {
    auto loaded = load();
    if (!loaded) {
      say(loaded.error());
      return false;
    }
    places_ = *std::move(loaded);
  }
  return true;
}

// The program's own places are on the Earth. On another body coordinates can be searched without a list.
Result<Gazetteer> Search::load() const {
  if (!file_.empty()) return Gazetteer::load(file_);
  if (context_.globe.options().body.name != earth().name) return Gazetteer();
  try {
    auto places = Gazetteer::load(data_file("cities.json"));
    if (!places) return places;
    if (Status added = places->add_areas(data_file("map.json")); !added) return added.error();
    return places;
  } catch (const BrokenInstallation& broken) {
    return Error{broken.what()};
  }
}

std::string Search::place_shown() {
  constexpr double kMiddle = 0.15;  // share of the window's height
  if (!can_open()) return {};
  const Viewport size = context_.window.framebuffer();
  const View view = context_.globe.view(size);
  const Ground ground = context_.globe.ground();
  const auto middle = pick(view, ground, context_.middle_px());
  if (!middle) return {};
  const NamedPlace* place =
      places_->near(*middle, Angle::degrees(kMiddle * size.height_px * pixel_step_deg(view, ground)));
  return place == nullptr ? std::string() : full_name(*place);
}

void Search::toggled() {
  text_.clear();
  if (is_open()) remove_mark();
  if (!is_open()) context_.ui.expect_text(false);
}

void Search::take_keyboard() {
  Panel::take_keyboard();
  context_.ui.expect_text(true);
}

void Search::draw_open(float foot) {
  const float unit = ImGui::GetFontSize();
  const float middle = 0.5F * ImGui::GetIO().DisplaySize.x;
  const float half = std::min(0.5F * kSearchWidth * unit, middle - 0.8F * unit);
  place_panel(Ui::panel_room(middle - half, middle + half, foot));
  ImGui::SetNextWindowBgAlpha(0.9F);
  const auto chosen = draw_field();
  if (chosen) fly_to(*chosen);
}

/// Returns the clicked place, or the first result on Enter.
std::optional<NamedPlace> Search::draw_field() {
  const bool just_opened = take_just_opened();
  if (just_opened) ImGui::SetNextWindowFocus();
  begin_panel(panel());
  std::array<char, 80> text{};
  text_.copy(text.data(), text.size() - 1);
  if (just_opened) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1.0F);
  const bool entered = ImGui::InputTextWithHint("##place", "Place name or coordinates, then Enter", text.data(),
                                                text.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  if (ImGui::IsItemActive()) context_.ui.field_is_ready();
  text_ = text.data();
  want_letters(text_);
  std::optional<NamedPlace> chosen;
  if (const auto place = read_place(text_)) {
    const NamedPlace named{.name = place_text(*place, kCoordinateStep_deg), .place = *place};
    if (ImGui::Selectable(named.name.c_str()) || entered) chosen = named;
  } else {
    chosen = draw_found(entered);
  }
  ImGui::End();
  return chosen;
}

/// The list of found places: the clicked one, or with `entered` the first.
std::optional<NamedPlace> Search::draw_found(bool entered) const {
  std::optional<NamedPlace> chosen;
  const auto found = places_->find(text_, kMostFound);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const std::string name = wrapped(full_name(*found[k]), ImGui::GetContentRegionAvail().x);
    if (ImGui::Selectable(fmt::format("{}###{}", name, k).c_str())) chosen = *found[k];
  }
  if (found.empty() && !text_.empty()) {
    const bool none = places_->size() == 0;
    write_wrapped(none ? "No list of places for this body: give one with --places" : "No place has this name");
  }
  if (entered && !found.empty()) chosen = *found.front();
  return chosen;
}

void Search::fly_to(const NamedPlace& place) {
  toggle();
  Camera camera = context_.navigator.camera();
  const double wanted_m = std::max(kPlaceHeight * context_.globe.options().body.ellipsoid.a_m(),
                                   kCountryHeight * 1000.0 * std::sqrt(place.area_km2));
  const double sharp_m = context_.navigator.texel_stop_m(finest_texel_m_(place.place).value_or(0.0));
  camera.eye = place.place;
  camera.eye.height_m = std::max(wanted_m, sharp_m);
  camera.heading = Angle{};
  camera.pitch = Angle::degrees(-90.0);
  context_.navigator.fly_to(camera, Input::now());
  const Status marked = place.area_km2 > 0.0 ? Done{} : mark(place);  // an area has its name on the map
  if (!marked) return say(marked.error());
  say(full_name(place) + (sharp_m > wanted_m ? ". The imagery has no finer detail here; E adds more." : ""));
}

Status Search::mark(const NamedPlace& place) {
  remove_mark();
  const float size_px = kMark_px * context_.window.text_scale();
  ObjectScene scene;
  scene.points.push_back({.place = place.place, .size_px = size_px, .heights = HeightMode::clamp_to_ground});
  scene.labels.push_back({.text = place.name,
                          .place = place.place,
                          .size_px = size_px,
                          .priority = 1.0,
                          .heights = HeightMode::clamp_to_ground});
  const Result<LayerId> added = context_.globe.add_objects(std::move(scene));
  if (!added) return added.error();
  mark_ = *added;
  return Done{};
}

bool Search::remove_mark() {
  if (!mark_) return false;
  const Status removed = context_.globe.remove(*std::exchange(mark_, std::nullopt));
  if (!removed) say(removed.error());
  return true;
}

}  // namespace terrella
