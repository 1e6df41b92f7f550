// Rectangles of the panels around the globe: none covers another, and no label lies under one.

#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "apps/viewer/panels/control_column.h"
#include "apps/viewer/panels/legend.h"
#include "apps/viewer/panels/measure_row.h"
#include "apps/viewer/panels/status_line.h"
#include "apps/viewer/panels/ui.h"
#include "apps/viewer/panels/view_settings.h"
#include "apps/viewer/parts/graticule_lines.h"
#include "apps/viewer/viewer.h"
#include "panel_screen.h"

namespace terrella {
namespace {

using test::Screen;

/// A frame that is begun.
class PanelBoxes : public test::PanelScreen {
 protected:
  void SetUp() override {
    PanelScreen::SetUp();
    ImGui::NewFrame();
  }
  void TearDown() override {
    ImGui::EndFrame();
    PanelScreen::TearDown();
  }
};

TEST_P(PanelBoxes, TheStatusLineAndTheScaleBarDoNotOverlap) {
  PanelStatus status;
  status.cursor = "46.02100 N   7.74900 E   4,478 m";
  status.eye = "Altitude 15,200 km";
  status.tiles = "127 tiles loading";
  status.time = "2026-06-21 12:00 UTC";
  status.scale = ScaleBar{
      .length_m = 2.0e6, .text = "2,000 km", .width_px = std::min(150.0 * GetParam().scale, 0.5 * GetParam().width)};
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

void draw_all(float width, float scale, bool with_panel) {
  PanelStatus status;
  status.cursor = "46.02100 N   7.74900 E   4,478 m";
  status.eye = "Altitude 15,200 km";
  status.attribution = "NASA Blue Marble, Natural Earth";
  status.scale = ScaleBar{.length_m = 2.0e6, .text = "2,000 km", .width_px = std::min(150.0 * scale, 0.5 * width)};
  const float foot = draw_status(status, 1.0);
  draw_head(status);
  if (with_panel) {
    ViewSettings settings;
    EXPECT_EQ(draw_view_settings("View", settings, Viewer::actions(), foot, false), nullptr);
  }
  NumberLook look;
  look.high = 30.0;
  draw_legend({{.title = "Temperature", .unit = "°C", .look = look}}, 12.0 * scale,
              window_height() - foot - 12.0 * scale);
  EXPECT_EQ(draw_measure_row("Length 10,008 km + 5,004 km = 15,011 km   Area 63,758,059 km²", foot), MeasureAsk::none);
  EXPECT_EQ(draw_control_column(Viewer::actions(), {}).clicked, nullptr);
}

// The row of a measurement and the buttons stand where nothing else is, or are left out.
TEST_P(PanelBoxes, TheRowOfAMeasurementAndTheControlColumnOverlapNothing) {
  for (const bool with_panel : {false, true}) {
    for (int frame = 0; frame < 3; ++frame) {  // panels find their size in the first
      ImGui::EndFrame();
      ImGui::NewFrame();
      draw_all(GetParam().width, GetParam().scale, with_panel);
    }
    const auto box_of = [](const char* name) { return Ui::shown_box(name).value_or(UiBox{}); };
    for (const char* name : {"##measure", "##controls"}) {
      const UiBox box = box_of(name);
      EXPECT_GE(box.left, 0.0);
      EXPECT_GE(box.top, 0.0);
      EXPECT_LE(box.right, GetParam().width);
      EXPECT_LE(box.bottom, GetParam().height);
      int found = 0;
      for (const UiBox& other : Ui::panel_boxes()) found += other.overlaps(box) ? 1 : 0;
      EXPECT_LE(found, 1) << name << " overlaps more than itself";
    }
    if (GetParam().width / GetParam().scale < 640) continue;
    const UiBox column = box_of("##controls");
    EXPECT_GT(column.bottom - column.top, 9 * 1.5 * ImGui::GetFontSize()) << "all buttons have room";
    EXPECT_GT(box_of("##measure").right, 0.0);
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

TEST_P(PanelBoxes, AnEyeOfAnAnaglyphWritesItsChannelsAlone) {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const PicturePart part{.size = {int(GetParam().width), int(GetParam().height)}, .channels = kRedChannel};
  begin_part(list, part, 1.0);
  list->AddLine({0.0F, 0.0F}, {9.0F, 9.0F}, ink({255.0F, 255.0F, 255.0F}, 255));
  end_part(list);
  std::vector<std::uintptr_t> channels;
  for (const ImDrawCmd& command : list->CmdBuffer) {
    if (command.UserCallback != nullptr) channels.push_back(reinterpret_cast<std::uintptr_t>(command.UserCallbackData));
  }
  EXPECT_EQ(channels, (std::vector<std::uintptr_t>{kRedChannel, kAllChannels}));
}

INSTANTIATE_TEST_SUITE_P(Sizes, PanelBoxes,
                         testing::Values(Screen{200, 150, 1}, Screen{320, 240, 1}, Screen{640, 480, 1},
                                         Screen{640, 480, 2}, Screen{800, 600, 2}, Screen{1280, 800, 1}));

}  // namespace
}  // namespace terrella
