#pragma once

#include <deque>

#include "apps/viewer/window.h"

namespace terrella {

/// Dear ImGui bound to a window: context, font, style, drawing. Panels keep events only while one is open that changes
/// something. The state of the keys is followed always, whoever keeps the event. thread: main
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
  [[nodiscard]] static bool panel_has_keyboard();
  /// Text and panels for the window's scale, which has changed. Not within a frame.
  static void rescale(const Window& window);
  /// On: a field is about to open, and characters wait for it until field_is_ready(). Off: the field closed, and
  /// characters that still wait are dropped.
  void expect_text(bool on);
  /// The field that was expected has the keyboard.
  void field_is_ready() { field_ready_ = true; }
  /// True if keys or characters wait for another frame.
  [[nodiscard]] bool has_waiting() const { return !waiting_.empty(); }
  // Hand an event of the window on; true if a panel keeps it, and false while no events are taken.
  static bool on_button(GLFWwindow* window, int button, int action, int modifiers);
  static bool on_scroll(GLFWwindow* window, double x, double y);
  bool on_key(int key, int action);
  bool on_character(unsigned character);
  static void on_enter(GLFWwindow* window, int entered);
  static void on_focus(GLFWwindow* window, int focused);
  /// Of the panels' font, in units of the window; within a frame.
  [[nodiscard]] static double text_height();

 private:
  enum class Stroke { press, release, character };
  struct KeyEvent {
    Stroke stroke;
    unsigned code;  ///< GLFW's number of the key, or the character
  };
  void hand_over_waiting();

  std::deque<KeyEvent> waiting_;  ///< in the order in which they came
  bool text_expected_ = false;
  bool field_ready_ = false;
};

}  // namespace terrella
