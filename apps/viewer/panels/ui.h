#pragma once

#include <deque>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/viewer/panels/readout.h"
#include "apps/viewer/window.h"

namespace terrella {

inline constexpr const char* kMenuTitle = "Menu";

/// Rectangle in units of the window.
struct UiBox {
  double left, top, right, bottom;
  [[nodiscard]] bool overlaps(const UiBox& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
  [[nodiscard]] bool has_size_of(const UiBox& other) const {
    return right - left == other.right - other.left && bottom - top == other.bottom - other.top;
  }
};

/// Dear ImGui for a window: context, font, style and drawing. Panels keep the mouse's events over them, and keys only
/// while an interactive panel is open. Key states are always tracked, even for events that a panel keeps. thread: main
class Ui {
 public:
  explicit Ui(const Window& window);  ///< the window must outlive it
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  /// Panels may be created between begin_frame() and end_frame(); end_frame() draws them into the current framebuffer.
  void begin_frame();
  void end_frame();
  /// Enables or disables the keyboard in panels.
  void take_events(bool on);
  /// On: panels keep every press and turn of the wheel, also beside them, as while a menu is open.
  void hold_mouse(bool on) { mouse_held_ = on; }
  /// True if a panel that takes the mouse is at a place, in units of the window.
  [[nodiscard]] static bool is_over_panel(glm::dvec2 at);
  /// Size of a panel by its title, in units of the window; 0 × 0 before its first frame.
  [[nodiscard]] static glm::dvec2 size_of(const char* title);
  /// True if a text field has the keyboard.
  [[nodiscard]] static bool has_text_field();
  /// True while a list of choices or a colour picker is open, which Esc closes first.
  [[nodiscard]] static bool has_open_list();
  /// Marks the item that has the keyboard, before the first key.
  static void show_focus();
  /// Moves the keyboard from the globe to the panel with this title, or from any panel to the globe.
  static void pass_keyboard(const char* title);
  [[nodiscard]] static bool panel_has_keyboard();
  /// Gives the keys and characters from now on to the globe; pass_keyboard() follows in the frame. Nothing happens if
  /// the globe has the keyboard.
  void leave_panel();
  /// Adjusts text and panels to the window's new scale at the next frame.
  void rescale() { rescaled_ = true; }
  /// On: a text field will open, and characters wait until field_is_ready(). Off: the field closed, and waiting
  /// characters are dropped.
  void expect_text(bool on);
  /// The expected field now has the keyboard.
  void field_is_ready() { field_ready_ = true; }
  /// True if keys, characters or the letters of panels wait for another frame.
  [[nodiscard]] bool has_waiting() const;
  // Event handlers. They return true if a panel keeps the event, and false while events are disabled.
  // `at` is the pointer's place, in units of the window.
  bool on_button(GLFWwindow* window, int button, int action, int modifiers, glm::dvec2 at) const;
  bool on_scroll(GLFWwindow* window, double x, double y, glm::dvec2 at) const;
  bool on_key(int key, int action);
  bool on_character(unsigned character);
  static void on_enter(GLFWwindow* window, int entered);
  static void on_focus(GLFWwindow* window, int focused);
  /// Sets font and style: the text's size at 96 dots per inch times `scale`, in units of `unit_px` pixels each. Not
  /// within a frame.
  static void use_text(float scale, float unit_px = 1.0F);
  /// Height of the panels' font, in units of the window; within a frame.
  [[nodiscard]] static double text_height();
  /// Rectangles of the panels that this frame has so far, without tips, lists of choices and the menu; within a frame.
  [[nodiscard]] static std::vector<UiBox> panel_boxes();
  /// Names and rectangles of all windows of Dear ImGui in this frame so far, tips and lists of choices too, as JSON;
  /// the rectangles of labels; and the names of panels with mouse whose contents are cut at the right in the last
  /// frame. Units of the window, from left, top to right, bottom.
  [[nodiscard]] static std::string boxes_text(const std::vector<UiBox>& labels);
  /// Rectangles of the panels with mouse and keyboard that the last frame had; within a frame.
  [[nodiscard]] static std::vector<UiBox> last_panels();
  /// Rectangle of the panel with this title when it was last drawn; nullopt if it never was.
  [[nodiscard]] static std::optional<UiBox> panel_box(const char* title);
  /// Rectangle of the panel with this title, if this frame has it so far.
  [[nodiscard]] static std::optional<UiBox> shown_box(const char* title);
  /// The room of a panel between two abscissas: under the texts at the window's upper edge, and above those at the
  /// lower edge, of which the status line takes `foot` units. Within a frame.
  [[nodiscard]] static UiBox panel_room(float left, float right, float foot);
  /// Counts opened panels, so that the newest one can be told.
  [[nodiscard]] unsigned next_panel() { return ++panels_; }
  /// Units of the lengths in panels and labels.
  [[nodiscard]] LengthUnits units() const { return units_; }
  void use_units(LengthUnits units) { units_ = units; }

 private:
  enum class Stroke { press, release, character };
  struct KeyEvent {
    Stroke stroke;
    unsigned code;  ///< GLFW's key number, or the character
  };
  void hand_over_waiting();

  const Window& window_;
  std::deque<KeyEvent> waiting_;  ///< in order of arrival
  unsigned panels_ = 0;
  LengthUnits units_ = LengthUnits::metric;
  bool text_expected_ = false;
  bool field_ready_ = false;
  bool mouse_held_ = false;
  bool rescaled_ = false;
};

}  // namespace terrella
