#pragma once

#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "apps/viewer/action.h"
#include "apps/viewer/panels/ui.h"
#include "apps/viewer/window.h"
#include "view/navigation.h"

namespace terrella {

/// Bookmark request: keys 1 to 9 fly to a bookmark; with Ctrl they store the current view.
struct BookmarkKey {
  int number = 0;
  bool set = false;
};

/// An action, or a click without a drag.
struct InputEvent {
  const Action* action = nullptr;  ///< null: a click
  PointerButton button = PointerButton::left;
  glm::dvec2 at_px{0.0};  ///< place of a click, framebuffer pixels
};

/// Steps of a drag with the left button.
enum class DragStep { begin, move, end };

/// Detects double clicks by time and distance.
class ClickPair {
 public:
  /// True if this press completes a double click; a third press starts a new pair. `slack_px` is the greatest distance
  /// between the two.
  [[nodiscard]] bool press(glm::dvec2 at_px, Seconds now, double slack_px);

 private:
  struct Press {
    glm::dvec2 at_px;
    Seconds when;
  };
  std::optional<Press> first_;
};

/// Handles a window's events: passes the pointer to the navigator and queues actions for the viewer. Lives as long as
/// the window. thread: main
class Input {
 public:
  /// `actions` must outlive the input.
  Input(Window& window, Ui& ui, Navigator& navigator, std::span<const Action> actions);
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  /// Handles pending events. With `wait_s`, first waits up to this many seconds for an event.
  void listen(std::optional<double> wait_s = {});
  /// Actions and clicks since the last call, in order.
  [[nodiscard]] std::vector<InputEvent> take_events();
  [[nodiscard]] std::optional<BookmarkKey> take_bookmark();  ///< latest request since the last call
  /// Sets who is asked first about drags with the left button. A `begin` that returns true takes the whole drag from
  /// the globe. The pixel is one of the framebuffer.
  void set_dragger(std::function<bool(DragStep step, glm::dvec2 at_px)> dragger) { dragger_ = std::move(dragger); }
  /// Files and folders dropped onto the window since the last call.
  [[nodiscard]] std::vector<std::filesystem::path> take_dropped();
  /// Enables or disables flying to a place by double click.
  void set_double_clicks(bool on) { double_clicks_ = on; }
  /// True while the left or the right button is held on the globe.
  [[nodiscard]] bool is_button_held() const { return dragging_ || pressed_px_.has_value() || right_.has_value(); }
  /// True if an event since the last call can change the picture.
  [[nodiscard]] bool take_dirty();
  [[nodiscard]] bool dirty() const { return dirty_; }
  /// Position of the cursor, framebuffer pixels; nullopt outside the window.
  [[nodiscard]] std::optional<glm::dvec2> cursor_px() const;
  /// True if the cursor is over a panel that takes the mouse.
  [[nodiscard]] bool is_over_panel() const { return Ui::is_over_panel(pointer_unit()); }
  [[nodiscard]] static Seconds now();

 private:
  void listen_to_pointer();
  void listen_to_keys();
  void listen_to_window();
  [[nodiscard]] glm::dvec2 pointer_unit() const { return pointer_px_ / window_.pixels_per_unit(); }
  void on_button(int button, int action, int modifiers);
  void on_release(PointerButton which, glm::dvec2 at, double slack_px);
  void on_further_button(int button, int action);
  void on_key(int key, int action, int modifiers, bool taken);
  [[nodiscard]] const Action* action_of(int key, int modifiers) const;
  bool on_ctrl(const char* name, int modifiers);
  void on_character(unsigned character);
  void queue(const Action& action);

  Window& window_;
  Ui& ui_;  ///< receives every event first
  Navigator& navigator_;
  std::span<const Action> actions_;
  /// Cursor position at the last event. The window only knows the current position, which differs from the position of
  /// a button press after a slow frame.
  glm::dvec2 pointer_px_;
  std::function<bool(DragStep, glm::dvec2)> dragger_;
  bool dragging_ = false;  ///< the dragger has the left button
  ClickPair clicks_;
  bool double_clicks_ = true;
  std::optional<BookmarkKey> bookmark_;
  std::vector<std::filesystem::path> dropped_;
  struct RightPress {
    glm::dvec2 at_px;
    Camera camera;  ///< before the press
  };
  std::optional<glm::dvec2> pressed_px_;
  std::optional<RightPress> right_;
  std::vector<InputEvent> queued_;
  bool dirty_ = true;
  Seconds heard_until_;     ///< time when events were last handled
  Seconds late_{0.0};       ///< greatest possible age of the events being handled
  bool repeating_ = false;  ///< the key, or the next character, comes from a held key
};

}  // namespace terrella
