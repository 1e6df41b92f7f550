#pragma once

#include <vector>

#include "apps/viewer/window.h"

namespace terrella {

/// Dear ImGui bound to a window: context, font, style, drawing. It takes events only while a panel is open that changes
/// something, from whoever listens to the window. thread: main
class Ui {
 public:
  explicit Ui(const Window& window);
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  /// Between begin_frame() and end_frame() panels may be made; end_frame() draws them into the current framebuffer.
  void begin_frame();
  void end_frame();
  /// Whether mouse and keyboard work in panels.
  void take_events(bool on);
  /// The keyboard goes from the globe to the panel with this title, or from whichever panel has it to the globe.
  static void pass_keyboard(const char* title);
  /// Text and panels for the window's scale, which has changed. Not within a frame.
  static void rescale(const Window& window);
  /// A field is about to open, or is open: what is written meanwhile is for it, from now on and not only when it has
  /// the keyboard.
  void expect_text(bool on);
  // Hand an event of the window on; true if the panel keeps it. Without effect while no events are taken.
  static bool on_button(GLFWwindow* window, int button, int action, int modifiers);
  static bool on_scroll(GLFWwindow* window, double x, double y);
  bool on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers);
  bool on_character(GLFWwindow* window, unsigned character);
  static void on_enter(GLFWwindow* window, int entered);
  /// Of the panels' font, in units of the window; within a frame.
  [[nodiscard]] static double text_height();

 private:
  std::vector<int> released_keys_;  ///< since the last frame
  bool text_expected_ = false;
  std::vector<unsigned> written_;  ///< before the field had the keyboard
};

}  // namespace terrella
