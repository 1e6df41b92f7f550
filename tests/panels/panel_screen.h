#pragma once

#include <gtest/gtest.h>
#include <imgui.h>

#include <ostream>

namespace terrella::test {

struct Screen {
  float width, height;
  float scale;
};

inline void PrintTo(const Screen& screen, std::ostream* out) {
  *out << screen.width << " x " << screen.height << " at " << screen.scale;
}

/// Panels without a window and without OpenGL.
class PanelScreen : public testing::TestWithParam<Screen> {
 protected:
  void SetUp() override {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {GetParam().width, GetParam().height};
    ImFontConfig config;
    config.SizePixels = 15.0F * GetParam().scale;
    io.Fonts->AddFontDefault(&config);
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
    ImGui::GetStyle().ScaleAllSizes(GetParam().scale);
  }
  void TearDown() override { ImGui::DestroyContext(); }
};

}  // namespace terrella::test
