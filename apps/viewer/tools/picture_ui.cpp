#include "apps/viewer/tools/picture_ui.h"

#include <epoxy/gl.h>
// epoxy comes before other headers of OpenGL
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>

#include "apps/viewer/panels/ui.h"

namespace terrella {
namespace {

/// Pictures up to this height have text of the window's size; taller ones have larger text.
constexpr float kPlainHeight_px = 1024.0F;
constexpr float kMost = 8.0F;

/// A context of Dear ImGui without a window.
class PictureUi {
 public:
  PictureUi() { ImGui::CreateContext(); }
  ~PictureUi() {
    if (drawn_) ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
  }
  PictureUi(const PictureUi&) = delete;
  PictureUi& operator=(const PictureUi&) = delete;

  [[nodiscard]] bool open(Viewport size) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {static_cast<float>(size.width_px), static_cast<float>(size.height_px)};
    Ui::use_text(std::clamp(io.DisplaySize.y / kPlainHeight_px, 1.0F, kMost));
    drawn_ = ImGui_ImplOpenGL3_Init("#version 450 core");
    return drawn_;
  }

 private:
  bool drawn_ = false;
};

}  // namespace

Status draw_over_picture(unsigned framebuffer, Viewport size, const std::function<void()>& draw) {
  PictureUi ui;
  if (!ui.open(size)) {
    return Error{"legend and map cannot be drawn: libGL is missing; leave --legend and --map out, or install it"};
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, size.width_px, size.height_px);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
  draw();
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  return Done{};
}

}  // namespace terrella
