#include "apps/viewer/panels/place_search.h"

#include <imgui.h>

#include <array>
#include <utility>

namespace terrella {
namespace {

constexpr std::size_t kMostFound = 8;
constexpr float kSearchWidth = 22.0F;  // in text heights
constexpr float kTop = 3.6F;           // below the attribution

}  // namespace

std::optional<NamedPlace> draw_place_search(PlaceSearch& search, const Gazetteer& places) {
  const float unit = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.5F * ImGui::GetIO().DisplaySize.x, kTop * unit}, ImGuiCond_Always, {0.5F, 0.0F});
  ImGui::SetNextWindowSize({kSearchWidth * unit, 0.0F});
  ImGui::SetNextWindowBgAlpha(0.9F);
  if (search.just_opened) ImGui::SetNextWindowFocus();
  ImGui::Begin(kSearchTitle, nullptr,
               ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_NoSavedSettings);
  std::array<char, 80> text{};
  search.text.copy(text.data(), text.size() - 1);
  if (std::exchange(search.just_opened, false)) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1.0F);
  const bool entered = ImGui::InputTextWithHint("##place", "Place name, then Enter; Esc closes", text.data(),
                                                text.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  search.has_keyboard = ImGui::IsItemActive();
  search.text = text.data();
  std::optional<NamedPlace> chosen;
  const auto found = places.find(search.text, kMostFound);
  for (const NamedPlace* place : found) {
    const std::string line = place->country.empty() ? place->name : place->name + ", " + place->country;
    if (ImGui::Selectable((line + "##" + place->folded).c_str())) chosen = *place;
  }
  if (found.empty() && !search.text.empty()) ImGui::TextDisabled("No match among %zu places", places.size());
  if (entered && !found.empty()) chosen = *found.front();
  ImGui::End();
  return chosen;
}

}  // namespace terrella
