#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
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
  /// Actions since the last call, in order.
  [[nodiscard]] std::vector<const Action*> take_actions();
  /// Positions of left clicks without a drag since the last call, framebuffer pixels.
  [[nodiscard]] std::vector<glm::dvec2> take_clicks();
  [[nodiscard]] std::optional<BookmarkKey> take_bookmark();  ///< latest request since the last call
  /// Files and folders dropped onto the window since the last call.
  [[nodiscard]] std::vector<std::filesystem::path> take_dropped();
  /// Enables or disables flying to a place by double click.
  void set_double_clicks(bool on) { double_clicks_ = on; }
  /// True while the left button is held.
  [[nodiscard]] bool is_button_held() const { return pressed_px_.has_value(); }
  /// True if an event since the last call can change the picture.
  [[nodiscard]] bool take_dirty();
  [[nodiscard]] bool dirty() const { return dirty_; }
  /// Position of the cursor, framebuffer pixels; nullopt outside the window.
  [[nodiscard]] std::optional<glm::dvec2> cursor_px() const;
  [[nodiscard]] static Seconds now();

 private:
  void listen_to_pointer();
  void listen_to_keys();
  void listen_to_window();
  void on_button(int button, int action, int modifiers);
  void on_key(int key, int action, int modifiers, bool taken);
  bool on_ctrl(const char* name);
  void on_character(unsigned character);
  void queue(const Action& action);

  Window& window_;
  Ui& ui_;  ///< receives every event first
  Navigator& navigator_;
  std::span<const Action> actions_;
  /// Cursor position at the last event. The window only knows the current position, which differs from the position of
  /// a button press after a slow frame.
  glm::dvec2 pointer_px_;
  ClickPair clicks_;
  bool double_clicks_ = true;
  std::optional<BookmarkKey> bookmark_;
  std::vector<std::filesystem::path> dropped_;
  std::optional<glm::dvec2> pressed_px_;
  std::vector<glm::dvec2> clicks_px_;
  std::vector<const Action*> queued_;
  bool dirty_ = true;
  Seconds heard_until_;     ///< time when events were last handled
  Seconds late_{0.0};       ///< greatest possible age of the events being handled
  bool repeating_ = false;  ///< the key, or the next character, comes from a held key
};

}  // namespace terrella
