#include "apps/viewer/panel_items.h"

namespace terrella {
namespace {

constexpr float kTipWidth = 26.0F;  // of the text's height

}  // namespace

void tip(const char* text) {
  const bool chosen = ImGui::IsItemFocused() && ImGui::GetIO().NavVisible;
  if (!ImGui::IsItemHovered() && !chosen) return;
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
