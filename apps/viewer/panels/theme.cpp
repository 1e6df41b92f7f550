#include "apps/viewer/panels/theme.h"

#include <imgui.h>

namespace terrella {
namespace {

/// A colour as 0xRRGGBB.
ImVec4 color(unsigned rgb, float alpha = 1.0F) {
  const auto part = [rgb](unsigned shift) { return static_cast<float>((rgb >> shift) & 0xFFU) / 255.0F; };
  return {part(16), part(8), part(0), alpha};
}

void set_colors(ImVec4* colors) {
  const ImVec4 ink = color(0xE8F0F7), quiet = color(0x9EB3C7), ground = color(0x0D141F, 0.84F);
  const ImVec4 field = color(0x1C2A3C), field_hovered = color(0x24364D), field_active = color(0x2C4260);
  const ImVec4 button = color(0x22405F), hovered = color(0x2B5580), active = color(0x336699);
  const ImVec4 mark = color(0x6FB1F5), line = color(0x6E7F92, 0.5F);
  colors[ImGuiCol_Text] = ink;
  colors[ImGuiCol_TextDisabled] = quiet;
  colors[ImGuiCol_TextSelectedBg] = color(0x336699, 0.8F);
  colors[ImGuiCol_WindowBg] = ground;
  colors[ImGuiCol_PopupBg] = color(0x121B28, 0.97F);
  colors[ImGuiCol_Border] = color(0x8092A6, 0.9F);
  colors[ImGuiCol_Separator] = line;
  colors[ImGuiCol_FrameBg] = field;
  colors[ImGuiCol_FrameBgHovered] = field_hovered;
  colors[ImGuiCol_FrameBgActive] = field_active;
  colors[ImGuiCol_TitleBg] = colors[ImGuiCol_TitleBgCollapsed] = color(0x16212F);
  colors[ImGuiCol_TitleBgActive] = color(0x1B3A5C);
  colors[ImGuiCol_Button] = button;
  colors[ImGuiCol_ButtonHovered] = hovered;
  colors[ImGuiCol_ButtonActive] = active;
  colors[ImGuiCol_Header] = color(0x1E3853);  // rows of lists, with quiet texts
  colors[ImGuiCol_HeaderHovered] = color(0x23446A);
  colors[ImGuiCol_HeaderActive] = color(0x1B3A5C);
  colors[ImGuiCol_CheckMark] = colors[ImGuiCol_SliderGrab] = mark;
  colors[ImGuiCol_SliderGrabActive] = colors[ImGuiCol_NavHighlight] = color(0xA8D3FF);
  colors[ImGuiCol_ScrollbarBg] = color(0x0D141F, 0.4F);
  colors[ImGuiCol_ScrollbarGrab] = color(0x40536A);
  colors[ImGuiCol_ScrollbarGrabHovered] = color(0x54708F);
  colors[ImGuiCol_ScrollbarGrabActive] = mark;
  colors[ImGuiCol_PlotHistogram] = mark;
}

}  // namespace

void set_theme(float scale) {
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  ImGui::StyleColorsDark();
  set_colors(style.Colors);
  style.WindowRounding = style.PopupRounding = 7.0F;
  style.FrameRounding = style.GrabRounding = 4.0F;
  style.WindowBorderSize = style.PopupBorderSize = 0.0F;
  style.FrameBorderSize = 1.0F;
  style.WindowPadding = ImVec2(12.0F, 7.0F);
  style.ItemSpacing = ImVec2(10.0F, 5.0F);
  style.ScaleAllSizes(scale);
}

}  // namespace terrella
