#include "apps/viewer/panels/measure_row.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "apps/viewer/panels/free_place.h"
#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kMeasureMargin = 0.8F;  // in text heights, to the window's edge
constexpr float kMeasureTop = 3.6F;     // in text heights, below the attribution
constexpr float kUnder = 0.6F;          // in text heights, over the status line

struct MeasureButton {
  MeasureAsk ask;
  const char* name;
  const char* why;
};
constexpr std::array<MeasureButton, 4> kMeasureButtons{{
    {MeasureAsk::undo, "Undo", "Backspace: removes the last place."},
    {MeasureAsk::copy, "Copy", "Ctrl + C: copies places, lengths and area as text."},
    {MeasureAsk::save, "Save", "Ctrl + S: saves a GeoJSON file in the folder where the program was started."},
    {MeasureAsk::end, "End", "M: ends measuring and removes the lines."},
}};

float width_of_buttons() {
  const ImGuiStyle& style = ImGui::GetStyle();
  float width = -style.ItemSpacing.x;
  for (const MeasureButton& button : kMeasureButtons) {
    width += ImGui::CalcTextSize(button.name).x + 2.0F * style.FramePadding.x + style.ItemSpacing.x;
  }
  return width;
}

/// The row without padding; a narrow row wraps the text.
ImVec2 inner_size(const std::string& text, float widest) {
  const ImVec2 words = ImGui::CalcTextSize(text.c_str(), nullptr, false, widest);
  return {std::max(words.x, width_of_buttons()), words.y + ImGui::GetStyle().ItemSpacing.y + ImGui::GetFrameHeight()};
}

/// Places for the row, the best first: at the top, over the status line, then both with wrapped text.
std::vector<UiBox> candidates_of(const std::string& text, float foot) {
  const float unit = ImGui::GetFontSize(), margin = kMeasureMargin * unit;
  const ImVec2 size = ImGui::GetIO().DisplaySize, padding = ImGui::GetStyle().WindowPadding;
  std::vector<UiBox> candidates;
  for (const float widest : {size.x - 2.0F * (margin + padding.x), width_of_buttons()}) {
    const ImVec2 inner = inner_size(text, widest);
    const float wide = inner.x + 2.0F * padding.x, high = inner.y + 2.0F * padding.y;
    for (const float top : {kMeasureTop * unit, size.y - foot - kUnder * unit - high}) {
      for (const float left : {0.5F * (size.x - wide), margin, size.x - margin - wide}) {
        candidates.push_back({left, top, left + wide, top + high});
      }
    }
  }
  return candidates;
}

}  // namespace

MeasureAsk draw_measure_row(const std::string& text, float foot) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const std::vector<UiBox> candidates = candidates_of(text, foot);
  const UiBox* free = first_free(candidates, {0.0, 0.0, window.x, window.y}, Ui::panel_boxes());
  MeasureAsk ask = MeasureAsk::none;
  if (free == nullptr) return ask;
  ImGui::SetNextWindowPos({float(free->left), float(free->top)});
  ImGui::SetNextWindowSize({float(free->right - free->left), float(free->bottom - free->top)});
  ImGui::Begin("##measure", nullptr, kFloatingWindow);
  ImGui::PushTextWrapPos(0.0F);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  for (std::size_t i = 0; i < kMeasureButtons.size(); ++i) {
    if (i > 0) ImGui::SameLine();
    if (ImGui::Button(kMeasureButtons[i].name)) ask = kMeasureButtons[i].ask;
    tip(kMeasureButtons[i].why);
  }
  ImGui::End();
  return ask;
}

}  // namespace terrella
