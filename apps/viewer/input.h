#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "apps/viewer/panels/ui.h"
#include "apps/viewer/window.h"
#include "view/navigation.h"

namespace terrella {

/// What a key asks of the viewer beside the navigation.
enum class ViewerAction {
  toggle_help,
  toggle_graticule,
  toggle_panel,
  toggle_full_screen,
  save_screenshot,
  next_alpha,
  next_stereo,
  toggle_sky,
  toggle_underground,
  toggle_measuring,
  measure_middle,
  take_back,
  find_place,
  toggle_layers,
  picture,
  panel_focus,
  leave
};

/// A bookmark that was asked for: 1 to 9 flies there, with Ctrl it is set to what is seen.
struct BookmarkKey {
  int number = 0;
  bool set = false;
};

/// Finds double clicks by time and distance.
class ClickPair {
 public:
  /// True if this press is the second of a pair; a third begins a new one. `slack_px`: how far apart they may be.
  [[nodiscard]] bool press(glm::dvec2 at_px, Seconds now, double slack_px);

 private:
  struct Press {
    glm::dvec2 at_px;
    Seconds when;
  };
  std::optional<Press> first_;
};

/// Listens to a window's events: hands them to the navigator and keeps the actions for the viewer. Lives as long as
/// the window does. thread: main
class Input {
 public:
  Input(Window& window, Ui& ui, Navigator& navigator);
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;

  /// Hears the window's events; with a time to wait for, seconds, not before there is one or that time is over.
  void listen(std::optional<double> wait_s = {});
  /// What was asked for since the last call, in order.
  [[nodiscard]] std::vector<ViewerAction> take_actions();
  /// Where the left button was last pressed and let go without a drag since the last call, framebuffer pixels.
  [[nodiscard]] std::vector<glm::dvec2> take_clicks();
  [[nodiscard]] std::optional<BookmarkKey> take_bookmark();  ///< the last one since the last call
  /// Files and folders that were dropped onto the window since the last call.
  [[nodiscard]] std::vector<std::filesystem::path> take_dropped();
  /// Whether two clicks are a double click, which flies there.
  void set_double_clicks(bool on) { double_clicks_ = on; }
  /// True if anything happened since the last call that can change the picture.
  [[nodiscard]] bool take_dirty();
  [[nodiscard]] bool dirty() const { return dirty_; }
  /// Where the cursor is, framebuffer pixels; nothing while it is outside the window.
  [[nodiscard]] std::optional<glm::dvec2> cursor_px() const;
  [[nodiscard]] static Seconds now();

 private:
  void listen_to_pointer();
  void listen_to_keys();
  void listen_to_window();
  void tilt_by_key(NavigationKey key);
  void on_button(int button, int action, int modifiers);
  void on_key(int key, int action, int modifiers, bool taken);
  void on_character(unsigned character);

  Window& window_;
  Ui& ui_;  ///< hears of everything first
  Navigator& navigator_;
  /// Of the last event. The window would say where the cursor is now, and after a slow frame that is not where a button
  /// went down.
  glm::dvec2 pointer_px_;
  ClickPair clicks_;
  bool double_clicks_ = true;
  std::optional<BookmarkKey> bookmark_;
  std::vector<std::filesystem::path> dropped_;
  std::optional<glm::dvec2> pressed_px_;
  std::vector<glm::dvec2> clicks_px_;
  std::vector<ViewerAction> actions_;
  bool dirty_ = true;
  Seconds heard_until_;     ///< when the window's events were last heard
  Seconds late_{0.0};       ///< how old those may be that are being heard
  bool repeating_ = false;  ///< the character that follows is a held key's
};

}  // namespace terrella
