#pragma once

#include "apps/viewer/window.h"

namespace terrella {

/// Dear ImGui bound to a window: context, font, style, drawing. It takes no events: the viewer's panels are read only.
/// thread: main
class Ui {
 public:
  explicit Ui(const Window& window);
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  /// Between begin_frame() and end_frame() panels may be made; end_frame() draws them into the current framebuffer.
  void begin_frame();
  void end_frame();
  /// Of the panels' font, in units of the window; within a frame.
  [[nodiscard]] static double text_height();
};

}  // namespace terrella
