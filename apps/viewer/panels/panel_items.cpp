#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kTipWidth = 18.0F;  // in text heights

}  // namespace

void tip(const char* text) {
  const bool chosen = ImGui::IsItemFocused() && ImGui::GetIO().NavVisible;
  if (!ImGui::IsItemHovered() && !chosen) return;
  // Beside the panel, where the tip does not hide the next items.
  const ImVec2 panel = ImGui::GetWindowPos();
  const bool left = panel.x + 0.5F * ImGui::GetWindowWidth() < 0.5F * ImGui::GetIO().DisplaySize.x;
  const float side = left ? panel.x + ImGui::GetWindowWidth() : panel.x;
  ImGui::SetNextWindowPos({side, ImGui::GetItemRectMin().y}, ImGuiCond_Always, {left ? 0.0F : 1.0F, 0.0F});
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(kTipWidth * ImGui::GetFontSize());
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void group(const char* name) {
  ImGui::Spacing();
  ImGui::TextDisabled("%s", name);
  ImGui::Separator();
}

void slide(const char* name, double& value, double from, double to, const char* format, ImGuiSliderFlags flags) {
  auto shown = static_cast<float>(value);
  if (ImGui::SliderFloat(name, &shown, static_cast<float>(from), static_cast<float>(to), format, flags)) {
    value = static_cast<double>(shown);
  }
}

}  // namespace terrella
