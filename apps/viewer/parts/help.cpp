#include "apps/viewer/parts/help.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kAiry = 1.45F;         // height of a row, in text heights, if there is room
constexpr float kGap = 1.8F;           // in text heights, between keys and texts
constexpr float kRoom = 0.94F;         // largest part of the window
constexpr float kLeastLetters = 0.7F;  // share of the text height; a list that needs smaller letters scrolls
constexpr float kIndent = 1.0F;        // in text heights, of the ways under an action
constexpr ImGuiWindowFlags kList = kPanelWindow | ImGuiWindowFlags_NoTitleBar;

}  // namespace

/// The list as three columns. Sizes are in units of the window.
struct Help::Columns {
  float keys = 0.0F, mice = 0.0F, whats = 0.0F;  ///< widths at full size
  float room_wide = 0.0F, room_high = 0.0F;      ///< for the text
  float scale = 1.0F;                            ///< factor for the letters, so that all columns and rows have room
};

Help::Columns Help::columns() const {
  Columns columns;
  float count = 0.0F;
  for (const Action& action : actions_) {
    if (action.keys == nullptr) continue;
    ++count;
    columns.keys = std::max(columns.keys, ImGui::CalcTextSize(action.keys).x);
    columns.mice = std::max(columns.mice, ImGui::CalcTextSize(mouse_way(action)).x);
    columns.whats = std::max(columns.whats, ImGui::CalcTextSize(action.what).x);
  }
  const ImVec2 size = ImGui::GetIO().DisplaySize, padding = ImGui::GetStyle().WindowPadding;
  const float unit = ImGui::GetFontSize(), wide = columns.keys + columns.mice + 2.0F * kGap * unit + columns.whats;
  columns.room_wide = kRoom * size.x - 2.0F * padding.x;
  columns.room_high = kRoom * size.y - 2.0F * padding.y;
  columns.scale = std::min({1.0F, columns.room_wide / wide, columns.room_high / (count * unit)});
  return columns;
}

// A small window shows the whole list in small letters; a smaller one scrolls it.
void Help::draw_open(float) {
  const Columns all = columns();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const bool just_opened = take_just_opened();
  ImGui::SetNextWindowBgAlpha(0.9F);
  ImGui::SetNextWindowPos({0.5F * size.x, 0.5F * size.y}, ImGuiCond_Always, {0.5F, 0.5F});
  if (just_opened) ImGui::SetNextWindowFocus();
  all.scale >= kLeastLetters ? draw_columns(all) : draw_scrolled(all, just_opened);
  // A press on the scroll bar is not a press on the list.
  if (!just_opened && ImGui::IsWindowHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) close();
  ImGui::End();
}

void Help::draw_columns(const Columns& all) const {
  const auto count = float(std::ranges::count_if(actions_, [](const Action& one) { return one.keys != nullptr; }));
  const float text = all.scale * ImGui::GetFontSize(), gap = kGap * text;
  const float line = std::clamp(all.room_high / count, text, kAiry * text);
  const float second = all.scale * all.keys + gap, third = second + all.scale * all.mice + gap;
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  ImGui::SetNextWindowSize(
      {std::ceil(third + all.scale * all.whats + 2.0F * padding.x), std::ceil(line * count + 2.0F * padding.y)});
  ImGui::Begin(panel(), nullptr, kList | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::SetWindowFontScale(all.scale);
  ImVec2 at = ImGui::GetCursorPos();
  at.y += 0.5F * (line - text);
  for (const Action& row : actions_) {
    if (row.keys == nullptr) continue;
    ImGui::SetCursorPos(at);
    ImGui::TextUnformatted(row.keys);
    ImGui::SetCursorPos({at.x + second, at.y});
    ImGui::TextUnformatted(mouse_way(row));
    ImGui::SetCursorPos({at.x + third, at.y});
    ImGui::TextDisabled("%s", row.what);
    at.y += line;
  }
}

// Each action with its ways under it, wrapped to the window.
void Help::draw_scrolled(const Columns& all, bool just_opened) const {
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  const float unit = ImGui::GetFontSize();
  const float wide = std::min(all.room_wide, all.whats + all.mice);
  ImGui::SetNextWindowSize({std::ceil(wide + 2.0F * padding.x), std::ceil(all.room_high + 2.0F * padding.y)});
  ImGui::Begin(panel(), nullptr, kList);
  if (just_opened) ImGui::SetScrollY(0.0F);
  ImGui::PushTextWrapPos(0.0F);
  for (const Action& row : actions_) {
    if (row.keys == nullptr) continue;
    ImGui::TextDisabled("%s", row.what);
    ImGui::Indent(kIndent * unit);
    ImGui::TextUnformatted(row.keys);
    if (mouse_way(row)[0] != '\0') ImGui::Text("Mouse: %s", mouse_way(row));
    ImGui::Unindent(kIndent * unit);
  }
  ImGui::PopTextWrapPos();
}

}  // namespace terrella
