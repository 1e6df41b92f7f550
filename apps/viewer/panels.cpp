#include "apps/viewer/panels.h"

#include <imgui.h>

#include <algorithm>

namespace terrella {
namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                                    ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav |
                                    ImGuiWindowFlags_NoBringToFrontOnFocus;
constexpr float kMargin = 0.8F;  // of the text's height, between panels and the window's edge
const ImU32 kInk = IM_COL32(232, 240, 248, 255);
const ImU32 kShade = IM_COL32(0, 0, 0, 150);

constexpr const char* kHelp[][2] = {
    {"Drag", "hold the ground and move it"},
    {"Wheel", "zoom to the cursor"},
    {"Right drag, Ctrl + drag", "tilt and turn"},
    {"Double click", "fly there"},
    {"Arrows", "move"},
    {"+  -", "zoom"},
    {"N", "north up"},
    {"Home", "whole globe"},
    {"G", "graticule"},
    {"F", "full screen"},
    {"F12", "save a picture of the window"},
    {"F1  ?", "this help"},
    {"Esc", "leave"},
};

ImVec2 to_ui(glm::dvec2 px, double unit_px) {
  return {static_cast<float>(px.x / unit_px), static_cast<float>(px.y / unit_px)};
}

/// Starts a panel held by a corner: pivot (0, 1) is its lower left one.
void begin_panel(const char* name, ImVec2 at, ImVec2 pivot) {
  ImGui::SetNextWindowPos(at, ImGuiCond_Always, pivot);
  ImGui::Begin(name, nullptr, kFixed);
}

float margin() { return kMargin * ImGui::GetFontSize(); }

void draw_fields(const PanelStatus& status, ImVec2 lower_left) {
  begin_panel("##status", lower_left, {0.0F, 1.0F});
  bool first = true;
  const auto put = [&](const std::string& text, bool quiet) {
    if (text.empty()) return;
    if (!first) ImGui::SameLine(0.0F, 1.3F * ImGui::GetFontSize());
    first = false;
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(quiet ? ImGuiCol_TextDisabled : ImGuiCol_Text));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopStyleColor();
  };
  put(status.cursor, false);
  put(status.eye, false);
  put(status.tiles, true);
  put(status.frame, true);
  ImGui::End();
}

void draw_scale(const ScaleBar& bar, ImVec2 lower_right, double unit_px) {
  begin_panel("##scale", lower_right, {1.0F, 1.0F});
  const std::string text = length_text(bar.length_m);
  const float width = static_cast<float>(bar.width_px / unit_px);
  const float tick = 0.35F * ImGui::GetFontSize();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float text_width = ImGui::CalcTextSize(text.c_str()).x;
  const float row = std::max(width, text_width);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddText({at.x + 0.5F * (row - text_width), at.y}, kInk, text.c_str());
  const float left = at.x + 0.5F * (row - width);
  const float base = at.y + ImGui::GetFontSize() + tick + 2.0F;
  const ImVec2 points[] = {{left, base - tick}, {left, base}, {left + width, base}, {left + width, base - tick}};
  list->AddPolyline(points, 4, kInk, 0, 1.5F);
  ImGui::Dummy({row, base - at.y + 2.0F});
  ImGui::End();
}

void draw_note(const char* name, const std::string& text, ImVec2 at, ImVec2 pivot) {
  if (text.empty()) return;
  begin_panel(name, at, pivot);
  ImGui::TextUnformatted(text.c_str());
  ImGui::End();
}

void shaded_text(ImDrawList* list, ImVec2 at, const char* text) {
  for (const ImVec2 off : {ImVec2(1, 0), ImVec2(-1, 0), ImVec2(0, 1), ImVec2(0, -1)}) {
    list->AddText({at.x + off.x, at.y + off.y}, kShade, text);
  }
  list->AddText(at, kInk, text);
}

}  // namespace

void draw_status(const PanelStatus& status, double unit_px) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float gap = margin();
  draw_fields(status, {gap, size.y - gap});
  if (status.scale) draw_scale(*status.scale, {size.x - gap, size.y - gap}, unit_px);
  draw_note("##attribution", status.attribution, {size.x - gap, gap}, {1.0F, 0.0F});
  draw_note("##message", status.message, {0.5F * size.x, gap}, {0.5F, 0.0F});
}

void draw_help() {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowBgAlpha(0.9F);
  begin_panel("##help", {0.5F * size.x, 0.5F * size.y}, {0.5F, 0.5F});
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {0.8F * ImGui::GetFontSize(), 0.22F * ImGui::GetFontSize()});
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const auto& [keys, what] : kHelp) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(keys);
      ImGui::TableNextColumn();
      ImGui::TextDisabled("%s", what);
    }
    ImGui::EndTable();
  }
  ImGui::PopStyleVar();
  ImGui::End();
}

void draw_graticule(const Graticule& graticule, double unit_px) {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  std::vector<ImVec2> points;
  for (const GraticuleLine& line : graticule.lines) {
    points.clear();
    for (const glm::dvec2 px : line.points_px) points.push_back(to_ui(px, unit_px));
    const ImU32 colour = line.principal ? IM_COL32(255, 226, 150, 190) : IM_COL32(255, 255, 255, 105);
    list->AddPolyline(points.data(), static_cast<int>(points.size()), colour, 0, line.principal ? 1.6F : 1.0F);
  }
  for (const GraticuleLabel& label : graticule.labels) {
    const ImVec2 size = ImGui::CalcTextSize(label.text.c_str());
    const ImVec2 at = to_ui(label.at_px, unit_px);
    shaded_text(
        list, {at.x - static_cast<float>(label.anchor.x) * size.x, at.y - static_cast<float>(label.anchor.y) * size.y},
        label.text.c_str());
  }
}

}  // namespace terrella
