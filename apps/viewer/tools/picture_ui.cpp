#include "apps/viewer/tools/picture_ui.h"

#include <epoxy/gl.h>
// epoxy comes before other headers of OpenGL
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <iterator>

#include "apps/viewer/panels/over_globe.h"
#include "apps/viewer/panels/panel_fonts.h"
#include "apps/viewer/panels/status_line.h"
#include "apps/viewer/panels/ui.h"
#include "apps/viewer/parts/graticule_lines.h"

namespace terrella {
namespace {

/// Pictures up to this height have text of the window's size; taller ones have larger text.
constexpr float kPlainHeight_px = 1024.0F;
constexpr float kMost = 8.0F;
constexpr double kScaleBar = 10.0;      // in text heights, width at most
constexpr double kScaleBarShare = 0.5;  // width at most, share of the picture's
constexpr double kGap = 0.8;            // in text heights, to the picture's edge

/// A context of Dear ImGui of its own, beside that of a window.
class PictureUi {
 public:
  PictureUi() : before_(ImGui::GetCurrentContext()), own_(ImGui::CreateContext()) { ImGui::SetCurrentContext(own_); }
  ~PictureUi() {
    if (drawn_) ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext(own_);
    ImGui::SetCurrentContext(before_);
  }
  PictureUi(const PictureUi&) = delete;
  PictureUi& operator=(const PictureUi&) = delete;

  [[nodiscard]] bool open(Viewport size, int unit_px) {
    ImGuiIO& io = ImGui::GetIO();
    const auto unit = static_cast<float>(unit_px);
    io.IniFilename = nullptr;
    io.DisplaySize = {static_cast<float>(size.width_px), static_cast<float>(size.height_px)};
    io.DisplayFramebufferScale = {unit, unit};
    load_text();
    drawn_ = ImGui_ImplOpenGL3_Init("#version 450 core");
    return drawn_;
  }

  /// Loads the letters that the last frame wanted.
  void load_letters() {
    load_text();
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
  }

 private:
  static void load_text() {
    const ImGuiIO& io = ImGui::GetIO();
    Ui::use_text(std::clamp(io.DisplaySize.y / kPlainHeight_px, 1.0F, kMost), io.DisplayFramebufferScale.y);
  }

  ImGuiContext* before_;
  ImGuiContext* own_;
  bool drawn_ = false;
};

/// Lines first, then texts, and names where the texts leave room. False if the credits have none.
bool draw_overlay(const Globe& globe, Viewport size, const PictureOverlay& overlay, int unit_px) {
  const View view = globe.view(size);
  if (overlay.map != nullptr) overlay.map->draw_lines(globe, view, 1.0, MapDetail::full);
  const double gap = kGap * Ui::text_height();
  draw_legend(legend_with_room(overlay.legend, gap, size.height_px - gap), gap, size.height_px - gap);
  PanelStatus status;
  status.attribution = fmt::format("{}", fmt::join(overlay.credits, "   "));
  draw_head(status);
  if (overlay.scale_units) {
    const double most_px = std::min(kScaleBar * Ui::text_height(), kScaleBarShare * size.width_px);
    if (const auto bar = scale_bar(view, globe.ground(), most_px, *overlay.scale_units)) draw_scale(*bar);
  }
  std::vector<UiBox> taken = Ui::panel_boxes();
  std::ranges::move(object_labels(globe, unit_px), std::back_inserter(taken));
  if (overlay.graticule) {
    const std::vector<UiBox> labels = draw_graticule(globe, view, 1.0, 0.0, taken);
    taken.insert(taken.end(), labels.begin(), labels.end());
  }
  if (overlay.map != nullptr) overlay.map->draw_names_apart(globe, view, taken);
  return overlay.credits.empty() || Ui::shown_box(kAttributionBox).has_value();
}

/// Prepares a frame with the overlay. False if the credits have no room.
bool draw_frame(const Globe& globe, Viewport size, const PictureOverlay& overlay, int unit_px) {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
  const bool credited = draw_overlay(globe, size, overlay, unit_px);
  ImGui::Render();
  return credited;
}

}  // namespace

Status draw_over_picture(const Globe& globe, unsigned framebuffer, Viewport size, const PictureOverlay& overlay,
                         int unit_px) {
  if (overlay.empty()) return Done{};
  PictureUi ui;
  if (!ui.open(size, unit_px))
    return Error{"texts and lines cannot be drawn over the picture: libGL is missing; install it"};
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, unit_px * size.width_px, unit_px * size.height_px);
  bool credited = draw_frame(globe, size, overlay, unit_px);
  if (letters_wait()) {
    ui.load_letters();
    credited = draw_frame(globe, size, overlay, unit_px);
  }
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (credited) return Done{};
  return Error{fmt::format("{} x {} pixels have no room for the sources: choose a larger picture, or leave them out",
                           size.width_px, size.height_px)};
}

}  // namespace terrella
