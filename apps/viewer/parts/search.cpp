#include "apps/viewer/parts/search.h"

#include <imgui.h>

#include <array>

#include "apps/setup/data_dir.h"
#include "apps/viewer/input.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr double kPlaceHeight = 0.05;  // height above a found place, in radii
constexpr std::size_t kMostFound = 8;
constexpr float kSearchWidth = 22.0F;  // in text heights
constexpr float kTop = 3.6F;           // below the attribution

// Loads the list of places; without the list the globe still works.
Gazetteer load_places() {
  try {
    Result<Gazetteer> places = Gazetteer::load(data_file("populated_places_110m.geojson"));
    if (places) return *std::move(places);
  } catch (const BrokenInstallation&) {
  }
  return {};
}

std::string full_name(const NamedPlace& place) {
  return place.country.empty() ? place.name : place.name + ", " + place.country;
}

}  // namespace

bool Search::can_open() {
  if (!places_) places_ = load_places();
  if (places_->size() == 0) say("The program was installed without its list of places");
  return places_->size() > 0;
}

void Search::toggled() {
  text_.clear();
  if (!is_open()) context_.ui.expect_text(false);
}

void Search::take_keyboard() {
  Panel::take_keyboard();
  context_.ui.expect_text(true);
}

void Search::draw_open(float) {
  const float unit = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.5F * ImGui::GetIO().DisplaySize.x, kTop * unit}, ImGuiCond_Always, {0.5F, 0.0F});
  ImGui::SetNextWindowSize({kSearchWidth * unit, 0.0F});
  ImGui::SetNextWindowBgAlpha(0.9F);
  const auto chosen = draw_field();
  if (chosen) fly_to(*chosen);
}

/// Returns the clicked place, or the first result on Enter.
std::optional<NamedPlace> Search::draw_field() {
  const bool just_opened = take_just_opened();
  if (just_opened) ImGui::SetNextWindowFocus();
  ImGui::Begin(panel(), nullptr, kPanelWindow);
  std::array<char, 80> text{};
  text_.copy(text.data(), text.size() - 1);
  if (just_opened) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1.0F);
  const bool entered = ImGui::InputTextWithHint("##place", "Place name, then Enter; Esc closes", text.data(),
                                                text.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  if (ImGui::IsItemActive()) context_.ui.field_is_ready();
  text_ = text.data();
  std::optional<NamedPlace> chosen;
  const auto found = places_->find(text_, kMostFound);
  for (const NamedPlace* place : found) {
    if (ImGui::Selectable((full_name(*place) + "##" + place->folded).c_str())) chosen = *place;
  }
  if (found.empty() && !text_.empty()) ImGui::TextDisabled("No match among %zu places", places_->size());
  if (entered && !found.empty()) chosen = *found.front();
  ImGui::End();
  return chosen;
}

void Search::fly_to(const NamedPlace& place) {
  toggle();
  Camera camera = context_.navigator.camera();
  camera.eye = place.place;
  camera.eye.height_m = kPlaceHeight * context_.globe.options().body.ellipsoid.a_m();
  camera.heading = Angle{};
  camera.pitch = Angle::degrees(-90.0);
  context_.navigator.fly_to(camera, Input::now());
  say(full_name(place));
}

}  // namespace terrella
