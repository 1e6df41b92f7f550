// Texts and panels leave each other room, in windows of every size: rectangles are compared.

#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "apps/viewer/panels/layer_panel.h"
#include "apps/viewer/panels/legend.h"
#include "apps/viewer/panels/status_line.h"
#include "apps/viewer/panels/ui.h"
#include "apps/viewer/panels/view_settings.h"
#include "panel_screen.h"

namespace terrella {
namespace {

using test::Screen;

class PanelRoom : public test::PanelScreen {
 protected:
  /// The rectangles of the last of some frames; a panel fits its contents one frame late.
  static std::vector<UiBox> boxes_of(const std::function<void()>& draw) {
    std::vector<UiBox> boxes;
    for (int frame = 0; frame < 4; ++frame) {
      ImGui::NewFrame();
      draw();
      boxes = Ui::panel_boxes();
      ImGui::EndFrame();
    }
    return boxes;
  }
  static PanelStatus wordy() {
    PanelStatus status;
    status.cursor = "46.02100 N   7.74900 E   4,478 m";
    status.eye = "Altitude 15,200 km";
    status.tiles = "127 tiles loading";
    status.time = "2026-06-21 12:00 UTC";
    if (is_low()) {
      status.message = "Sky on";
      return status;
    }
    status.message = "Saved terrella-20260621-120000.png";
    status.job = "Cutting the_moon_in_colours.tif: 12 %; Esc cancels";
    status.attribution = "NASA Earth Observatory (Blue Marble Next Generation)   U.S. Geological Survey";
    status.scale = ScaleBar{
        .length_m = 2.0e6, .text = "2,000 km", .width_px = std::min(150.0 * GetParam().scale, 0.5 * GetParam().width)};
    return status;
  }
  /// Draws as the viewer does, with a panel between texts and legend.
  static void draw_all(const PanelStatus& status, const std::function<void(float)>& panel) {
    const float foot = draw_status(status, 1.0);
    draw_message(status, foot);
    draw_head(status);
    panel(foot);
  }
  static void expect_apart(const std::vector<UiBox>& boxes, std::size_t at_least) {
    EXPECT_GE(boxes.size(), at_least);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      EXPECT_GE(boxes[i].left, 0.0);
      EXPECT_GE(boxes[i].top, 0.0);
      EXPECT_LE(boxes[i].right, GetParam().width + 1.0F);  // sizes are whole pixels
      EXPECT_LE(boxes[i].bottom, GetParam().height + 1.0F);
      for (std::size_t k = 0; k < i; ++k) {
        EXPECT_FALSE(boxes[i].overlaps(boxes[k]))
            << "box " << i << " from " << boxes[i].left << ", " << boxes[i].top << " to " << boxes[i].right << ", "
            << boxes[i].bottom << " and " << k;
      }
    }
  }
  // A window where a panel is shown alone.
  static bool is_low() { return GetParam().height < 22.0F * 15.0F * GetParam().scale; }
};

TEST_P(PanelRoom, TheAttributionIsWrappedAndNeverCut) {
  PanelStatus status;
  status.attribution = "NASA Earth Observatory (Blue Marble Next Generation)";
  const std::vector<UiBox> boxes = boxes_of([&status] { draw_head(status); });
  ASSERT_EQ(boxes.size(), 1U);
  expect_apart(boxes, 1);
  const float text = 52.0F * 6.0F * GetParam().scale;  // the least width of its 52 letters in one row
  if (GetParam().width < text) {
    EXPECT_GT(boxes[0].bottom - boxes[0].top, 2.0 * 15.0 * double(GetParam().scale));
  }
}

TEST_P(PanelRoom, TextsDoNotCoverEachOther) {
  expect_apart(boxes_of([] { draw_all(wordy(), [](float) {}); }), is_low() ? 2 : 4);
}

TEST_P(PanelRoom, AMessageKeepsClearOfTheLegend) {
  if (is_low()) return;  // a low window shows one of the two
  const std::vector<LegendItem> items(1, {.title = "temperature", .unit = "K", .look = {}});
  expect_apart(boxes_of([&items] {
                 const float foot = draw_status(wordy(), 1.0);
                 draw_legend(items, 12.0, double(GetParam().height - foot) - 12.0);
                 draw_message(wordy(), foot);
               }),
               3);
}

TEST_P(PanelRoom, PanelsLeaveTheTextsTheirRoom) {
  if (is_low()) return;  // a tiny window shows a panel alone
  ViewSettings settings;
  settings.has_sky = settings.sky = settings.has_relief = true;
  const auto draw_view = [&settings](float foot) { (void)draw_view_settings("View", settings, {}, foot, false); };
  std::vector<LayerRow> rows(30, {.name = "layer"});
  const auto draw_rows = [&rows](float foot) { (void)draw_layers("Layers", rows, {}, foot, false); };
  expect_apart(boxes_of([&] { draw_all(wordy(), draw_view); }), 3);
  expect_apart(boxes_of([&] { draw_all(wordy(), draw_rows); }), 3);
}

INSTANTIATE_TEST_SUITE_P(Sizes, PanelRoom,
                         testing::Values(Screen{200, 150, 1}, Screen{400, 300, 1}, Screen{640, 480, 1},
                                         Screen{640, 480, 2}, Screen{1280, 960, 2}, Screen{1280, 800, 1}));

}  // namespace
}  // namespace terrella
