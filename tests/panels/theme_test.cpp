#include "apps/viewer/panels/theme.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace terrella {
namespace {

ImVec4 over(const ImVec4& top, const ImVec4& below) {
  const auto mix = [&](float a, float b) { return a * top.w + b * (1.0F - top.w); };
  return {mix(top.x, below.x), mix(top.y, below.y), mix(top.z, below.z), 1.0F};
}

/// Relative luminance of an sRGB colour as WCAG 2.2 defines it.
double luminance(const ImVec4& color) {
  const auto linear = [](float part) {
    const double value = static_cast<double>(part);
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(color.x) + 0.7152 * linear(color.y) + 0.0722 * linear(color.z);
}

double contrast(const ImVec4& one, const ImVec4& other) {
  const auto [dark, light] = std::minmax(luminance(one), luminance(other));
  return (light + 0.05) / (dark + 0.05);
}

class Theme : public testing::Test {
 protected:
  Theme() : context_(ImGui::CreateContext()) { set_theme(1.0F); }
  ~Theme() override { ImGui::DestroyContext(context_); }
  static ImVec4 color(ImGuiCol name) { return ImGui::GetStyle().Colors[name]; }
  /// The least contrast of a text on an item of a panel, over white and over black ground.
  static double least(ImGuiCol ink, ImGuiCol item) {
    double least = 21.0;
    for (const float ground : {0.0F, 1.0F}) {
      const ImVec4 panel = over(color(ImGuiCol_WindowBg), {ground, ground, ground, 1.0F});
      const ImVec4 under = item == ImGuiCol_WindowBg ? panel : over(color(item), panel);
      least = std::min(least, contrast(over(color(ink), under), under));
    }
    return least;
  }

 private:
  ImGuiContext* context_;
};

// 4.5: WCAG 2.2, success criterion 1.4.3.
TEST_F(Theme, EveryTextCanBeRead) {
  for (const ImGuiCol item :
       {ImGuiCol_WindowBg, ImGuiCol_PopupBg, ImGuiCol_TitleBg, ImGuiCol_TitleBgActive, ImGuiCol_FrameBg,
        ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive, ImGuiCol_Button, ImGuiCol_ButtonHovered, ImGuiCol_ButtonActive,
        ImGuiCol_Header, ImGuiCol_HeaderHovered, ImGuiCol_HeaderActive, ImGuiCol_TextSelectedBg}) {
    EXPECT_GE(least(ImGuiCol_Text, item), 4.5) << ImGui::GetStyleColorName(item);
  }
}

TEST_F(Theme, EveryQuietTextCanBeReadToo) {
  for (const ImGuiCol item :
       {ImGuiCol_WindowBg, ImGuiCol_PopupBg, ImGuiCol_TitleBg, ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered,
        ImGuiCol_FrameBgActive, ImGuiCol_Header, ImGuiCol_HeaderHovered, ImGuiCol_HeaderActive}) {
    EXPECT_GE(least(ImGuiCol_TextDisabled, item), 4.5) << ImGui::GetStyleColorName(item);
  }
}

// 3: success criteria 1.4.11 and 2.4.7, for marks and for the focus.
TEST_F(Theme, MarksAndFocusCanBeSeen) {
  for (const ImGuiCol mark : {ImGuiCol_CheckMark, ImGuiCol_SliderGrab}) {
    EXPECT_GE(least(mark, ImGuiCol_FrameBg), 3.0) << ImGui::GetStyleColorName(mark);
  }
  EXPECT_GE(least(ImGuiCol_Border, ImGuiCol_WindowBg), 3.0) << "of a box without its mark";
  EXPECT_GE(least(ImGuiCol_NavHighlight, ImGuiCol_WindowBg), 3.0);
  EXPECT_GE(least(ImGuiCol_NavHighlight, ImGuiCol_Button), 3.0);
}

}  // namespace
}  // namespace terrella
