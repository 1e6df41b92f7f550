#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/open_scene/options/source_options.h"
#include "apps/viewer/action.h"
#include "apps/viewer/balloon/balloon.h"
#include "apps/viewer/bodies/body_panel.h"
#include "apps/viewer/bodies/body_question.h"
#include "apps/viewer/catalogue/catalogue_panel.h"
#include "apps/viewer/draw/draw.h"
#include "apps/viewer/feature_list/feature_list.h"
#include "apps/viewer/flights/flights.h"
#include "apps/viewer/input.h"
#include "apps/viewer/offline/keep_offline.h"
#include "apps/viewer/panels/status_line.h"
#include "apps/viewer/panels/ui.h"
#include "apps/viewer/parts/bookmark_views.h"
#include "apps/viewer/parts/cutting.h"
#include "apps/viewer/parts/frame_graph.h"
#include "apps/viewer/parts/globe_frame.h"
#include "apps/viewer/parts/graticule_lines.h"
#include "apps/viewer/parts/help.h"
#include "apps/viewer/parts/layers.h"
#include "apps/viewer/parts/map_layer.h"
#include "apps/viewer/parts/measure.h"
#include "apps/viewer/parts/messages.h"
#include "apps/viewer/parts/open_dialog.h"
#include "apps/viewer/parts/pictures.h"
#include "apps/viewer/parts/place_menu.h"
#include "apps/viewer/parts/search.h"
#include "apps/viewer/parts/view_modes.h"
#include "apps/viewer/profile/profile.h"
#include "apps/viewer/projects/projects.h"
#include "apps/viewer/swipe/swipe.h"
#include "apps/viewer/timeline/timeline.h"
#include "apps/viewer/tools/kept_settings.h"
#include "apps/viewer/tools/view_history.h"
#include "apps/viewer/window.h"
#include "globe/globe.h"

namespace terrella {

struct ViewerOptions {
  Camera camera;
  bool print_camera = false;  ///< prints a line on standard output each time the camera comes to rest
  bool print_panels = false;  ///< prints the places of panels and labels on standard output each time they change
  std::vector<std::weak_ptr<GrowingCut>> cuts = {};  ///< in the background; the layers own them
  std::vector<LayerRow> layers = {};            ///< the globe's layers: heights, imagery from bottom to top, objects
  std::optional<ElevationSource> heights = {};  ///< the globe's heights
  SceneOptions scene = {};  ///< options of the scene: how files are opened, and what the window cannot change
  bool map = true;          ///< show the map, if there is one of the body
  KeptSettings kept = {};   ///< settings from the file
  LengthUnits units = LengthUnits::metric;
  bool hold_session = false;             ///< the kept session stays as it is until the scene changes
  bool first_run = false;                ///< true: show a hint
  std::string flight = {};               ///< file of a flight to play; empty: none
  std::string message = {};              ///< first message; may be empty
  std::vector<SourceOptions> open = {};  ///< files and addresses that become layers
};

/// The window's main loop: handles events, draws frames, and wires the parts of the viewer. Draws only on changes,
/// motion or loading; otherwise sleeps until the next event. thread: main
class Viewer {
 public:
  /// The window must be shown and its context current; window and globe must outlive the viewer.
  Viewer(Window& window, Globe& globe, const ViewerOptions& options);

  /// Runs until the user quits, or leaves for another scene. Returns that scene; nullopt: the user has quit.
  std::optional<NextScene> run();
  /// The scene as the window shows it, as a project without drawings.
  [[nodiscard]] SceneOptions scene() const;
  /// Units of the lengths that the window shows.
  [[nodiscard]] LengthUnits units() const { return ui_.units(); }

  /// All actions of the user, in the order of the list of shortcuts. thread: any
  [[nodiscard]] static std::span<const Action> actions();

 private:
  using Clock = std::chrono::steady_clock;
  static const Action kActions[];
  static constexpr int kPanelFrames = 3;  // a panel shows an event one frame later

  template <NavigationKey kKey>
  static void navigate(Viewer& viewer);
  template <int kRight, int kDown>
  static void turn(Viewer& viewer);
  void leave();
  void quit();
  void turn_back();
  void travel(const std::optional<Camera>& to, const char* nowhere);
  void pass_keyboard();
  void handle_events();
  void click(glm::dvec2 at_px);
  void add_middle();
  void take_back();
  void undo();
  void redo();
  void save_drawn();
  void toggle_swipe();
  [[nodiscard]] bool is_closed();
  void follow_panels();
  [[nodiscard]] Part* front_panel() const;
  [[nodiscard]] bool work() const;
  [[nodiscard]] double pause_s(Seconds waited) const;
  void wait_for_work();
  [[nodiscard]] std::string job() const;
  void tell_of_finest_texels();
  void draw_frame(Viewport framebuffer);
  void draw_panels(Viewport framebuffer);
  void draw_over_panels(const View& view, float foot);
  void draw_balloon(const View& view, float foot);
  [[nodiscard]] float draw_texts(const PanelStatus& status);
  void draw_legend(float foot, bool before_panels) const;
  void cover_panels(Viewport framebuffer);
  [[nodiscard]] PictureOverlay overlay();
  [[nodiscard]] std::vector<std::string> credits() const;
  [[nodiscard]] std::vector<LayerSwitch> switches();
  [[nodiscard]] PanelStatus status(const View& view);
  [[nodiscard]] KeptSettings now_kept();
  void keep_settings();
  void print_at_rest();
  void open_file(const std::filesystem::path& file);
  [[nodiscard]] bool may_leave();
  bool open_on_globe(const Body& body, std::vector<SourceOptions> files);
  void add_data(const CatalogueEntry& entry);

  Window& window_;
  Globe& globe_;
  ViewerOptions options_;
  bool said_memory_ = false;  ///< the user knows that the driver gives less than --memory
  std::string said_fault_;    ///< last fault of the globe, which each frame has again
  std::string said_letters_;  ///< last message about letters without a font
  Ui ui_;
  Navigator navigator_;
  Input input_;
  Messages messages_;
  const ViewerContext context_{window_, globe_, navigator_, ui_, messages_};
  GlobeFrame frame_;
  GraticuleLines graticule_{context_};
  MapLayer map_{context_, options_.scene.places};
  Help help_{context_, actions()};
  Pictures pictures_{context_, [this] { return overlay(); }};
  Search search_{context_, options_.scene.places,
                 [this](const Geodetic& place) { return layers_.finest_texel_m(place); }};
  BookmarkViews bookmarks_{context_, [this] { return search_.place_shown(); },
                           [this] { flights_.refresh_bookmarks(); }};
  FrameGraph frame_graph_{context_};
  Layers layers_;
  OpenDialog open_{context_, [this](const std::filesystem::path& file) { open_file(file); }};
  Projects projects_{context_, [this] { return scene(); }, [this] { return draw_.text(); }, options_.scene.project,
                     options_.kept.restore};
  BodyPanel body_{context_, [this](const Body& body) {
                    if (may_leave()) projects_.leave_for({.body = body});
                  }};
  BodyQuestion question_{
      context_,
      {.open_globe = [this](const Body& body, auto files) { return open_on_globe(body, std::move(files)); },
       .add_here = [this](SourceOptions file) { layers_.open(std::move(file)); }}};
  CataloguePanel catalogue_{context_, options_.scene.base.offline,
                            [this](const CatalogueEntry& entry) { add_data(entry); }};
  ViewModes modes_;
  Swipe swipe_{context_};
  Timeline timeline_{context_, [this] { return layers_.timed(); }};
  Draw draw_{context_};
  Profile profile_{context_, [this] { return measure_.places(); }, [this] { return layers_.shown_numbers(); }};
  Measure measure_{context_, [this](std::vector<Geodetic> places) { draw_.keep_measured(std::move(places)); },
                   [this] { profile_.toggle(); }};
  Balloon balloon_{context_,
                   [this](LayerId layer) { return draw_.owns(layer) ? "Drawings" : layers_.shown_objects(layer); }};
  FeatureList list_{context_,
                    {.has_layer = [this](LayerId layer) { return layers_.has_objects(layer); },
                     .chosen = [this](LayerId layer) { return balloon_.chosen_of(layer); },
                     .choose = [this](LayerId layer, const ListedFeature& one) { balloon_.choose(layer, one); },
                     .fly = [this] { balloon_.fly_there(); }}};
  Flights flights_{context_,
                   {.bookmarks = [this] { return bookmarks_.views(); },
                    .scene =
                        [this] {
                          SceneOptions now = scene();
                          now.drawings = draw_.text();
                          return now;
                        },
                    .opening = [this] { return !layers_.job().empty(); }}};
  KeepOffline keep_{context_, options_.scene.base};
  Cutting cutting_;
  PlaceMenu menu_{context_,
                  actions(),
                  {.run = [this](const Action& action) { action.run(*this); },
                   .measure_from = [this](glm::dvec2 at_px) { measure_.start_from(at_px); },
                   .bookmark = [this] { bookmarks_.save_as_next(); }}};
  ViewHistory history_{globe_.options().body.ellipsoid};
  bool button_held_ = false;        ///< a button of the control column is held down
  Clock::time_point quit_until_{};  ///< a second Esc quits until then
  Seconds turned_back_{-1.0e3};     ///< when the compass was last clicked
  /// In the order in which Esc closes them and F6 chooses a panel; drawn in the reverse order.
  const std::array<Part*, 22> parts_{&help_,     &menu_,     &question_,  &pictures_,  &search_, &open_,
                                     &projects_, &body_,     &catalogue_, &bookmarks_, &list_,   &balloon_,
                                     &profile_,  &timeline_, &draw_,      &flights_,   &keep_,   &layers_,
                                     &modes_,    &measure_,  &cutting_,   &map_};
  Part* front_ = nullptr;  ///< front_panel() at the last look
  int panel_frames_ = 0;   ///< frames still to draw
  Viewport panels_size_;   ///< framebuffer size in the last frame with panels
  bool was_at_texels_ = false;
  std::vector<UiBox> labels_;     ///< boxes of the labels of objects, graticule and map in the last frame
  std::string last_attribution_;  ///< PanelStatus::last_attribution; at first that of a layer
  std::string panels_text_;       ///< Ui::boxes_text() of the last frame
  std::string job_text_;          ///< job() in the last frame
  KeptSettings started_;          ///< settings at the start of the run
  KeptSettings saved_;            ///< settings in the file
  std::string printed_camera_, printed_panels_;
};

}  // namespace terrella
