// Rectangles of the panels around the globe: none covers another, and no label lies under one.

#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>
#include <string>
#include <vector>

#include "apps/viewer/panels/status_line.h"
#include "apps/viewer/panels/ui.h"
#include "apps/viewer/parts/graticule_lines.h"

namespace terrella {
namespace {

struct Screen {
  float width, height;
  float scale;
};

void PrintTo(const Screen& screen, std::ostream* out) {
  *out << screen.width << " x " << screen.height << " at " << screen.scale;
}

// Panels without a window and without OpenGL.
class PanelBoxes : public testing::TestWithParam<Screen> {
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
    ImGui::NewFrame();
  }
  void TearDown() override {
    ImGui::EndFrame();
    ImGui::DestroyContext();
  }
};

TEST_P(PanelBoxes, TheStatusLineAndTheScaleBarDoNotOverlap) {
  PanelStatus status;
  status.cursor = "46.02100 N   7.74900 E   4,478 m";
  status.eye = "Altitude 15,200 km";
  status.tiles = "127 tiles loading";
  status.frame = "8 ms";
  status.scale = ScaleBar{.length_m = 2.0e6, .width_px = std::min(150.0 * GetParam().scale, 0.5 * GetParam().width)};
  const float foot = draw_status(status, 1.0);
  const std::vector<UiBox> boxes = Ui::panel_boxes();
  ASSERT_FALSE(boxes.empty());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    EXPECT_GE(boxes[i].left, 0.0);
    EXPECT_LE(boxes[i].right, GetParam().width);
    EXPECT_GE(boxes[i].top, GetParam().height - foot - 1.0F);  // sizes are whole pixels
    for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(boxes[i].overlaps(boxes[k]));
  }
}

TEST_P(PanelBoxes, ALabelUnderAPanelIsLeftOut) {
  ImGui::SetNextWindowPos({20, 20});
  ImGui::SetNextWindowSize({100, 60});
  ImGui::Begin("panel");
  ImGui::End();
  const PicturePart part{.size = {int(GetParam().width), int(GetParam().height)}};
  const auto drawn = [&](glm::dvec2 at) {
    Graticule graticule;
    graticule.labels.push_back({.text = "10", .at_px = at, .anchor = {0.0, 0.0}});
    const int before = ImGui::GetBackgroundDrawList()->VtxBuffer.Size;
    draw_graticule(graticule, part, 1.0, Ui::panel_boxes());
    return ImGui::GetBackgroundDrawList()->VtxBuffer.Size > before;
  };
  EXPECT_FALSE(drawn({40.0, 40.0}));
  EXPECT_FALSE(drawn({118.0, 40.0}));
  EXPECT_TRUE(drawn({130.0, 100.0}));
}

INSTANTIATE_TEST_SUITE_P(Sizes, PanelBoxes,
                         testing::Values(Screen{200, 150, 1}, Screen{320, 240, 1}, Screen{640, 480, 1},
                                         Screen{640, 480, 2}, Screen{800, 600, 2}, Screen{1280, 800, 1}));

}  // namespace
}  // namespace terrella
