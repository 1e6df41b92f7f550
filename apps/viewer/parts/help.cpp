#include "apps/viewer/parts/help.h"

#include <imgui.h>

#include <algorithm>
#include <vector>

#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kAiry = 1.45F;  // height of a row, in text heights, if there is room
constexpr float kGap = 1.8F;    // in text heights, between keys and texts
constexpr float kRoom = 0.94F;  // largest part of the window

}  // namespace

// A small window shows the whole list in small letters.
void Help::draw_open(float) {
  std::vector<const Action*> rows;
  float keys = 0.0F, mice = 0.0F, whats = 0.0F;
  for (const Action& action : actions_) {
    if (action.keys == nullptr) continue;
    rows.push_back(&action);
    keys = std::max(keys, ImGui::CalcTextSize(action.keys).x);
    mice = std::max(mice, ImGui::CalcTextSize(mouse_way(action)).x);
    whats = std::max(whats, ImGui::CalcTextSize(action.what).x);
  }
  const ImVec2 size = ImGui::GetIO().DisplaySize, padding = ImGui::GetStyle().WindowPadding;
  const ImVec2 room{kRoom * size.x - 2.0F * padding.x, kRoom * size.y - 2.0F * padding.y};
  const float unit = ImGui::GetFontSize(), gap = kGap * unit, count = float(rows.size());
  const float scale = std::min({1.0F, room.x / (keys + mice + 2.0F * gap + whats), room.y / (count * unit)});
  const float text = scale * unit, line = std::clamp(room.y / count, text, kAiry * text);
  const float second = scale * (keys + gap), third = second + scale * (mice + gap);
  ImGui::SetNextWindowBgAlpha(0.9F);
  begin_fixed("##help", {0.5F * size.x, 0.5F * size.y}, {0.5F, 0.5F}, {third + scale * whats, line * count});
  ImGui::SetWindowFontScale(scale);
  ImVec2 at = ImGui::GetCursorPos();
  at.y += 0.5F * (line - text);
  for (const Action* row : rows) {
    ImGui::SetCursorPos(at);
    ImGui::TextUnformatted(row->keys);
    ImGui::SetCursorPos({at.x + second, at.y});
    ImGui::TextUnformatted(mouse_way(*row));
    ImGui::SetCursorPos({at.x + third, at.y});
    ImGui::TextDisabled("%s", row->what);
    at.y += line;
  }
  ImGui::End();
}

}  // namespace terrella
