#include "apps/viewer/panels/measure_row.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "apps/viewer/panels/free_place.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kMeasureMargin = 0.8F;  // in text heights, to the window's edge
/// The row has room for this text, so that it stays where it is while the lengths in it change.
constexpr const char* kLongMeasurement = "Length 10,000 km + 10,000 km = 20,000 km   Area 500,000,000 km²";

struct MeasureButton {
  MeasureAsk ask;
  const char* name;
  const char* why;
};
constexpr std::array<MeasureButton, 6> kMeasureButtons{{
    {MeasureAsk::undo, "Undo", "Backspace: removes the last place."},
    {MeasureAsk::copy, "Copy", "Ctrl + C: copies places, lengths and area as text."},
    {MeasureAsk::save, "Save", "Ctrl + S: saves a GeoJSON file in the folder where the program was started."},
    {MeasureAsk::keep, "Keep", "Ctrl + D: keeps the measured places as a drawing, and ends measuring."},
    {MeasureAsk::end, "End", "M: ends measuring and removes the lines."},
    {MeasureAsk::profile, "Profile", "Ctrl + P: shows heights and numbers along the path."},
}};
using Buttons = std::span<const MeasureButton>;

float width_of(Buttons buttons) {
  const ImGuiStyle& style = ImGui::GetStyle();
  float width = -style.ItemSpacing.x;
  for (const MeasureButton& button : buttons) {
    width += ImGui::CalcTextSize(button.name).x + 2.0F * style.FramePadding.x + style.ItemSpacing.x;
  }
  return width;
}

/// Size of the row without padding; a narrow row wraps the text.
ImVec2 inner_size(const std::string& text, float widest, Buttons buttons) {
  ImVec2 words = ImGui::CalcTextSize(text.c_str(), nullptr, false, widest);
  if (const float usual = ImGui::CalcTextSize(kLongMeasurement).x; usual <= widest) words.x = std::max(words.x, usual);
  if (buttons.empty()) return words;
  return {std::max(words.x, width_of(buttons)), words.y + ImGui::GetStyle().ItemSpacing.y + ImGui::GetFrameHeight()};
}

/// Places for the row, the best first: under the texts at the top, over those at the bottom, both with wrapped text.
std::vector<UiBox> candidates_of(const std::string& text, float foot, Buttons buttons) {
  const float margin = kMeasureMargin * ImGui::GetFontSize();
  const ImVec2 size = ImGui::GetIO().DisplaySize, padding = ImGui::GetStyle().WindowPadding;
  std::vector<UiBox> candidates;
  for (const float widest :
       {size.x - 2.0F * (margin + padding.x), buttons.empty() ? width_of(kMeasureButtons) : width_of(buttons)}) {
    const ImVec2 inner = inner_size(text, widest, buttons);
    const float wide = inner.x + 2.0F * padding.x, high = inner.y + 2.0F * padding.y;
    for (const bool top : {true, false}) {
      for (const float left : {0.5F * (size.x - wide), margin, size.x - margin - wide}) {
        const UiBox room = Ui::panel_room(left, left + wide, foot);
        const double from = top ? room.top : room.bottom - high;
        candidates.push_back({left, from, left + wide, from + high});
      }
    }
  }
  return candidates;
}

void begin_row(const UiBox& box) {
  ImGui::SetNextWindowPos({float(box.left), float(box.top)});
  ImGui::SetNextWindowSize({float(box.right - box.left), float(box.bottom - box.top)});
  ImGui::Begin("##measure", nullptr, kFloatingWindow);
}

}  // namespace

MeasureAsk draw_measure_row(const std::string& text, float foot) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  MeasureAsk ask = MeasureAsk::none;
  // A narrow room has none for the last button, and a small one for no button.
  for (const std::size_t count : {kMeasureButtons.size(), kMeasureButtons.size() - 1, std::size_t{0}}) {
    const Buttons buttons = Buttons(kMeasureButtons).first(count);
    const std::vector<UiBox> candidates = candidates_of(text, foot, buttons);
    const UiBox* free = first_free(candidates, {0.0, 0.0, size.x, size.y}, Ui::panel_boxes());
    if (free == nullptr) continue;
    begin_row(*free);
    ImGui::PushTextWrapPos(0.0F);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    for (const MeasureButton& button : buttons) {
      if (button.ask != kMeasureButtons[0].ask) ImGui::SameLine();
      if (ImGui::Button(button.name)) ask = button.ask;
      tip(button.why);
    }
    ImGui::End();
    break;
  }
  return ask;
}

}  // namespace terrella
