#include "apps/viewer/panels/picture_panel.h"

#include <algorithm>
#include <utility>

#include "apps/viewer/panels/panel_items.h"

namespace terrella {
namespace {

constexpr float kPictureWidth = 22.0F;  // in text heights

}  // namespace

PictureAsk draw_picture_panel(PicturePanel& panel, Viewport window, int most_px) {
  const float unit = ImGui::GetFontSize();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  if (panel.width_px <= 0) {
    panel.width_px = std::min(2 * window.width_px, most_px);
    panel.height_px = std::min(2 * window.height_px, most_px);
  }
  ImGui::SetNextWindowPos({0.5F * size.x, 0.5F * size.y}, ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::SetNextWindowSize({std::min(kPictureWidth * unit, size.x), 0.0F});
  ImGui::SetNextWindowBgAlpha(0.9F);
  if (panel.just_opened) ImGui::SetNextWindowFocus();
  ImGui::Begin(kPictureTitle, nullptr, kPanelWindow);
  ImGui::PushItemWidth(0.55F * kPictureWidth * unit);
  if (std::exchange(panel.just_opened, false)) ImGui::SetKeyboardFocusHere();
  ImGui::InputInt("Width", &panel.width_px, 64, 1024);
  tip("In pixels. The height shows the window's view; the width shows as much as fits.");
  ImGui::InputInt("Height", &panel.height_px, 64, 1024);
  tip("In pixels.");
  panel.width_px = std::clamp(panel.width_px, 1, most_px);
  panel.height_px = std::clamp(panel.height_px, 1, most_px);
  const bool save = ImGui::Button("Save");
  tip("Loads all tiles of the picture, then saves a PNG in the folder where the program was started.");
  ImGui::SameLine();
  const bool close = ImGui::Button("Close");
  ImGui::PushTextWrapPos(0.0F);
  ImGui::TextDisabled("Without panels. F12 saves a screenshot.");
  ImGui::PopTextWrapPos();
  ImGui::PopItemWidth();
  ImGui::End();
  if (save) return PictureAsk::save;
  return close ? PictureAsk::close : PictureAsk::none;
}

}  // namespace terrella
