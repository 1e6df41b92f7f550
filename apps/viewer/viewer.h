#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/setup/scene_options.h"
#include "apps/viewer/input.h"
#include "apps/viewer/panels/layer_panel.h"
#include "apps/viewer/panels/panels.h"
#include "apps/viewer/panels/picture_panel.h"
#include "apps/viewer/panels/place_search.h"
#include "apps/viewer/panels/ui.h"
#include "apps/viewer/tools/bookmarks.h"
#include "apps/viewer/tools/dropped_files.h"
#include "apps/viewer/tools/gazetteer.h"
#include "apps/viewer/tools/kept_settings.h"
#include "apps/viewer/tools/measure_tool.h"
#include "apps/viewer/tools/picture_job.h"
#include "apps/viewer/tools/view_settings.h"
#include "apps/viewer/window.h"
#include "globe/globe.h"
#include "render/gl/offscreen.h"

namespace terrella {

struct ViewerOptions {
  Camera camera;
  bool print_camera = false;                    ///< prints a line on standard output each time the camera comes to rest
  std::vector<LayerRow> layers = {};            ///< the globe's layers: heights, imagery from bottom to top, objects
  std::optional<ElevationSource> heights = {};  ///< the globe's heights
  SceneOptions files = {};                      ///< options for opening dropped files
  KeptSettings kept = {};                       ///< settings from the file
  KeptSettings start = {};                      ///< settings from the file, overridden by the command line
  bool first_run = false;                       ///< true: show a hint
  std::string message = {};                     ///< first message; may be empty
};

/// The window's main loop: handles events and draws frames. Draws only on changes, motion or loading; otherwise sleeps
/// until the next event. thread: main
class Viewer {
 public:
  /// The window must be shown and its context current; window and globe must outlive the viewer.
  Viewer(Window& window, Globe& globe, const ViewerOptions& options);

  /// Runs until the user quits.
  void run();

 private:
  using Clock = std::chrono::steady_clock;

  void begin_as_kept();
  [[nodiscard]] KeptSettings now_kept() const;
  void keep_settings();
  void wait_for_work();
  [[nodiscard]] bool work() const;
  void act(ViewerAction action);
  void next_alpha();
  void next_stereo();
  [[nodiscard]] bool under_ground() const;
  void toggle_underground();
  [[nodiscard]] double deepest_m() const;
  bool leave_something();
  void toggle_panel();
  void show_panels();
  void pass_keyboard();
  [[nodiscard]] bool any_panel() const;
  void toggle_layers();
  void draw_layer_panel();
  void take_look(LayerRow& row, const ImageLook& look);
  Status use_heights(const std::optional<ElevationSource>& heights);
  void move_layer(std::size_t row, bool up);
  void remove_layer(std::size_t row);
  void look_at(const GeoRect& bounds);
  void take_dropped();
  void add_layer(OpenedFile file);
  void insert_row(LayerRow row);
  void toggle_picture_panel();
  void draw_picture_panel();
  void start_picture(Viewport size);
  void end_picture(std::string message);
  void draw_picture(Viewport framebuffer);
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
  void say_too(const std::string& problem);
  void say(std::string message, Clock::duration time);
  void print_camera_at_rest();
  [[nodiscard]] PanelStatus status(const View& view) const;

  Window& window_;
  Globe& globe_;
  ViewerOptions options_;
  Ui ui_;
  Navigator navigator_;
  Input input_;
  std::optional<OffscreenTarget> picture_;  ///< last drawn globe, so that new panels need no new globe frame
  Viewport picture_size_;
  FrameStats stats_;             ///< statistics of `picture_`
  std::optional<Camera> above_;  ///< eye before it went under the ground
  bool sky_ = true;
  bool help_ = false;
  bool panel_ = false;
  bool panel_opened_ = false;  ///< since the last frame
  int panel_frames_ = 0;       ///< frames still to draw: panels show an event one frame late
  ViewSettings settings_;
  bool graticule_ = false;
  bool measuring_ = false;
  MeasureTool measure_;
  std::optional<LayerId> measure_layer_;
  Bookmarks bookmarks_;
  std::vector<LayerRow> layers_;
  bool layers_shown_ = false;
  bool layers_opened_ = false;  ///< since the last frame
  DroppedFiles dropped_;
  std::string problems_;      ///< errors of files dropped together
  std::string dropped_text_;  ///< text of the last frame
  bool picture_panel_shown_ = false;
  PicturePanel picture_panel_;
  std::unique_ptr<PictureJob> picture_job_;
  KeptSettings started_;  ///< settings at the start of the run
  KeptSettings saved_;    ///< settings in the file
  bool searching_ = false;
  std::optional<Gazetteer> places_;  ///< loaded at the first search
  PlaceSearch search_;
  bool screenshot_wanted_ = false;
  std::string message_;
  Clock::time_point message_until_{};
  std::chrono::duration<double, std::milli> frame_time_{0.0};
  std::string printed_camera_;
};

}  // namespace terrella
