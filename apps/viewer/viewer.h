#pragma once

#include <optional>
#include <string>

#include "apps/viewer/bookmarks.h"
#include "apps/viewer/gazetteer.h"
#include "apps/viewer/input.h"
#include "apps/viewer/measure_tool.h"
#include "apps/viewer/panels.h"
#include "apps/viewer/place_search.h"
#include "apps/viewer/ui.h"
#include "apps/viewer/view_settings.h"
#include "apps/viewer/window.h"
#include "engine/globe.h"
#include "render/offscreen.h"

namespace terrella {

struct ViewerOptions {
  Camera camera;
  bool print_camera = false;  ///< a line on standard output each time the camera comes to rest
};

/// The window's life: events in, frames out. Draws only when something changed, moves or is still loading; otherwise it
/// sleeps until the next event. thread: main
class Viewer {
 public:
  /// The window must be shown, its context current, and both outlive the viewer.
  Viewer(Window& window, Globe& globe, const ViewerOptions& options);

  /// Until the person leaves.
  void run();

 private:
  using Clock = std::chrono::steady_clock;

  void wait_for_work();
  [[nodiscard]] bool work() const;
  void act(ViewerAction action);
  void next_alpha();
  void next_stereo();
  void toggle_underground();
  [[nodiscard]] double deepest_m() const;
  void toggle_panel();
  void toggle_measuring();
  void measure_at(glm::dvec2 px);
  void draw_measure();
  void use(const BookmarkKey& key);
  void toggle_search();
  [[nodiscard]] const Gazetteer& places();
  void draw_search();
  void draw_settings();
  void draw_graticules(const View& view);
  void draw_frame(Viewport framebuffer);
  void draw_globe(Viewport framebuffer);
  void draw_panels(Viewport framebuffer);
  void save_screenshot(Viewport framebuffer);
  void say(std::string message);
  void print_camera_at_rest();
  [[nodiscard]] PanelStatus status(const View& view) const;

  Window& window_;
  Globe& globe_;
  ViewerOptions options_;
  Ui ui_;
  Navigator navigator_;
  Input input_;
  std::optional<OffscreenTarget> picture_;  ///< the globe as drawn last: panels over it cost no new one
  Viewport picture_size_;
  FrameStats stats_;             ///< of that
  std::optional<Camera> above_;  ///< where the eye was before it went under the ground
  bool sky_ = true;
  bool help_ = false;
  bool panel_ = false;
  bool panel_opened_ = false;  ///< since the last frame
  int panel_frames_ = 0;       ///< still to be drawn: a panel shows an event one frame later
  ViewSettings settings_;
  bool graticule_ = false;
  bool measuring_ = false;
  MeasureTool measure_;
  std::optional<LayerId> measure_layer_;
  Bookmarks bookmarks_;
  bool searching_ = false;
  std::optional<Gazetteer> places_;  ///< read when first searched
  PlaceSearch search_;
  bool screenshot_wanted_ = false;
  std::string message_;
  Clock::time_point message_until_{};
  std::chrono::duration<double, std::milli> frame_time_{0.0};
  std::string printed_camera_;
};

}  // namespace terrella
