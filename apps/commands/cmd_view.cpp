#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/commands/raster_facts.h"
#include "apps/open_scene/bounds_view.h"
#include "apps/open_scene/eye_place.h"
#include "apps/open_scene/open_imagery.h"
#include "apps/open_scene/open_rasters.h"
#include "apps/open_scene/open_scene.h"
#include "apps/open_scene/options/scene_options.h"
#include "apps/open_scene/project/read_project.h"
#include "apps/open_scene/scene_objects.h"
#include "apps/process/console.h"
#include "apps/process/stop_signals.h"
#include "apps/program/commands.h"
#include "apps/program/units_option.h"
#include "apps/viewer/bodies/body_names.h"
#include "apps/viewer/projects/projects.h"
#include "apps/viewer/tools/kept_json.h"
#include "apps/viewer/tools/map_data.h"
#include "apps/viewer/tools/recent_files.h"
#include "apps/viewer/viewer.h"
#include "streaming/cut/growing/growing_cut.h"
#include "streaming/georeference/figure.h"
#include "streaming/remote/describe_remote.h"

namespace terrella {
namespace {

constexpr Viewport kWindow{.width_px = 1280, .height_px = 800};
constexpr Viewport kSmallestWindow{.width_px = 320, .height_px = 240};  // lower bound for a kept size

constexpr const char* kHelpFooter =
    "Mouse: drag to move the ground, turn the wheel to zoom to the cursor, right-drag or Ctrl + drag to tilt and\n"
    "turn, double-click to fly there. Drop files onto the window, or press Ctrl + O, to add layers.\n"
    "Keys: arrows, + and - move; N north up, Home whole globe, R reset, G graticule, C map, F full screen,\n"
    "/ search, M measure, D draw, E add data, W body, L layers, J project, Y flight, P settings, U translucent,\n"
    "X under the ground, B sky, T play the time, S stereo, I and F12 save pictures, 1 to 9 fly to bookmarks,\n"
    "F1 or ? shortcuts, Esc twice quits.\n"
    "\n"
    "Examples:\n"
    "  terrella view                                      the Earth\n"
    "  terrella view cog_of_any_size.tif                  shows at once, nothing is stored\n"
    "  terrella view moon.tif --body moon                 a picture of the whole Moon, also from 0 to 360 degrees\n"
    "  terrella view --overlay flight_in_utm.tif          a picture in any projection, over the Earth\n"
    "  terrella view glaciers.terrella                    a project that the window saved\n"
    "  terrella view earth.gpkg --camera 46,7,3e5,30,-20  the Alps from the south west";

// Dark, so that objects under the ground stand out, and bright enough to look round.
const glm::vec3 kInnerSphere_srgb = glm::vec3(56.0F, 71.0F, 97.0F) / 255.0F;

struct ViewOptions {
  SceneOptions scene;
  bool print_camera = false;
  bool print_panels = false;
  bool full_screen = false;
  std::optional<LengthUnits> units;
  KeptSettings kept;
  bool first_run = false;
  std::string message;
  bool restored = false;            ///< the scene is that of the last session
  bool hold_session = false;        ///< ViewerOptions::hold_session
  std::string flight;               ///< file of a flight to play; empty: none
  std::vector<SourceOptions> open;  ///< files and addresses that become layers
};

/// True if the command line says nothing about the scene.
bool names_no_scene(const CLI::App& command) {
  constexpr std::array kBeside = {"--size",  "--fullscreen", "--print-camera", "--print-panels", "--units",
                                  "--cache", "--cache-size", "--memory",       "--offline"};
  return std::ranges::none_of(command.get_options(), [&kBeside](const CLI::Option* option) {
    return option->count() > 0 && std::ranges::find(kBeside, option->get_name()) == kBeside.end();
  });
}

/// Takes the scene of a session file. A file that cannot be read, or is not of the body, is kept under another name.
/// False without a scene.
bool take_session(const std::optional<std::filesystem::path>& file, ViewOptions& options, const Body* body = nullptr) {
  std::error_code failed;
  if (!file || !std::filesystem::exists(*file, failed)) return false;
  SceneOptions scene = options.scene;
  const Status read = read_project(*file, scene);
  if (!read) {
    options.message = set_aside(*file, read.error().message);
    return false;
  }
  if (body != nullptr && scene.base.body && are_two_bodies(*scene.base.body, *body)) {
    options.message = set_aside(*file, file->string() + ": it is of " + body_phrase(*scene.base.body));
    return false;
  }
  scene.size = options.scene.size;
  scene.project.clear();
  options.scene = std::move(scene);
  return true;
}

/// Begins with the scene that was last open.
void restore_session(ViewOptions& options) {
  options.restored = take_session(session_file(), options);
  if (options.restored) options.message = "The last session is restored; J begins a new one";
}

// Applies the kept settings of earlier runs; options on the command line have priority.
void begin_as_kept(ViewOptions& options, const CLI::App& command) {
  const auto file = settings_file();
  if (!file) return;
  LoadedSettings loaded = load_settings(*file);
  options.first_run = loaded.first_run;
  options.message = std::move(loaded.complaint);
  const KeptSettings& kept = options.kept = loaded.settings;
  SceneOptions& scene = options.scene;
  if (command.count("--size") == 0 && scene.project.empty() && kept.width_px > 0 && kept.height_px > 0) {
    scene.size = {std::max(kept.width_px, kSmallestWindow.width_px),
                  std::max(kept.height_px, kSmallestWindow.height_px)};
  }
  if (kept.restore && options.message.empty() && names_no_scene(command)) restore_session(options);
}

LayerRow heights_row(const OpenedScene& scene, const SceneOptions& options, const OpenedRasters& opened) {
  LayerRow row{.kind = LayerKind::heights,
               .name = shown_name(options.elevation.without_query()),
               .source = {.address = options.elevation},
               .attribution = scene.heights->tiles()->info().attribution,
               .read_facts = facts_reader(options.elevation, {}, {}, opened)};
  row.look.shown = options.elevation_shown;
  return row;
}

LayerRow image_row(const OpenedScene& scene, const SceneLayer& layer, const OpenedRasters& opened) {
  const SourceOptions& said = layer.source;
  const Url address = said.address.empty() ? Url(scene.base.name) : said.address;
  const DescribedBand band{.band = said.numbers.band, .nodata = said.numbers.nodata};
  LayerRow row{.id = layer.id,
               .name = said.remote.name ? shown_name(said) : shown_name(address.without_query()),
               .source = said,
               .numbers = layer.numbers};
  row.tiles = layer.tiles;
  row.source.cuts = nullptr;  // those of the opening end with it
  row.source.opened = nullptr;
  if (const auto look = scene.globe->look(layer.id)) row.look = *look;
  if (const auto attribution = scene.globe->attribution(layer.id)) row.attribution = *attribution;
  row.read_facts = facts_reader(address, said.place, band, opened);
  return row;
}

LayerRow objects_row(const OpenedScene& scene, SceneObjects& layer) {
  LayerRow row{.id = layer.id,
               .kind = LayerKind::objects,
               .name = std::filesystem::path(layer.option.file).filename().string(),
               .objects = layer.option,
               .bounds = layer.bounds};
  row.look.shown = layer.option.shown;
  row.look.opacity = layer.option.opacity;
  row.style = style_of_layer(std::move(layer.features), layer.style);
  row.features = std::make_shared<const std::vector<ListedFeature>>(std::move(layer.list));
  row.take_points(std::move(layer.points));
  if (const auto attribution = scene.globe->attribution(layer.id)) row.attribution = *attribution;
  return row;
}

/// The globe's layers: heights, imagery from bottom to top, objects.
std::vector<LayerRow> layer_rows(OpenedScene& scene, const SceneOptions& options, const std::optional<GeoRect>& part,
                                 const OpenedRasters& opened) {
  std::vector<LayerRow> rows;
  if (scene.heights) rows.push_back(heights_row(scene, options, opened));
  for (const SceneLayer& layer : scene.images) {
    rows.push_back(image_row(scene, layer, opened));
    if (layer.id != scene.images.front().id) continue;
    rows.back().bounds = part;
    rows.back().finest_level = scene.base.grid.max_level;
  }
  for (SceneObjects& layer : scene.objects) rows.push_back(objects_row(scene, layer));
  return rows;
}

std::string said_by(const Status& status) { return status ? std::string() : status.error().message; }

/// Puts the files of the command line into the list of recent files; the complaint if this fails.
std::string remember(const SceneOptions& scene) {
  std::vector<std::string> opened;
  if (!scene.project.empty()) return said_by(remember_opened(std::array{scene.project}));
  std::vector<Url> urls = {scene.base.address};
  for (const OverlayOption& overlay : scene.overlays) urls.push_back(overlay.tile_set);
  urls.push_back(scene.elevation);
  opened.reserve(urls.size() + 1);
  for (const Url& url : urls) opened.push_back(url.with_secrets());
  opened.push_back(scene.objects);
  std::erase(opened, std::string());
  return said_by(remember_opened(opened));
}

/// The end of an exploration.
struct Explored {
  std::optional<NextScene> next{};          ///< see Viewer::run()
  SceneOptions scene;                       ///< as it was at the end
  LengthUnits units = LengthUnits::metric;  ///< likewise
};

/// Message for the start: the complaint about the settings, or what a project leaves out, or nothing.
std::string first_message(const ViewOptions& options, const OpenedScene& scene) {
  if (!options.message.empty()) return options.message;
  if (scene.left_out.empty()) return remember(options.scene);
  if (scene.left_out.size() == 1) return scene.left_out.front();
  return fmt::format("{}; {} more layers are left out", scene.left_out.front(), scene.left_out.size() - 1);
}

Result<OpenedScene> open_for_window(const SceneOptions& wanted) {
  return open_scene(wanted, [&wanted](const Body& body) -> Result<GlobeOptions> {
    check_map(wanted, body);
    GlobeOptions with_sky = globe_options(wanted, body);
    add_sky_data(with_sky, true);  // the user may choose a time
    add_label_font(with_sky);
    return with_sky;
  });
}

/// Opens a scene in the window and lets the user explore it.
Result<Explored> explore(Window& window, const ViewOptions& options) {
  // Signals stop an unfinished cut cleanly; the window itself may be ended at any time.
  std::optional<StopSignals> signals(std::in_place);
  std::vector<std::shared_ptr<GrowingCut>> cuts;
  SceneOptions wanted = options.scene;
  wanted.base.cuts = &cuts;
  wanted.keep_features = true;
  auto opened = std::make_unique<OpenedRasters>();
  wanted.base.opened = opened.get();
  auto scene = open_for_window(wanted);
  if (!scene) return scene.error();
  if (StopSignals::came()) return Error{"stopped"};
  signals.reset();
  window.show();
  if (options.full_screen) window.toggle_full_screen();
  const auto part = scene->images.empty()
                        ? std::nullopt
                        : part_with_data(scene->images.front().source.address, scene->base.grid.bounds);
  const Camera asked = wanted.camera.value_or(default_camera(part, scene->body.ellipsoid, window.framebuffer()));
  // Later heights raise the eye with the ground, as everywhere in the window.
  const Camera start = out_of_ground(asked, 0.0, may_be_underground(wanted));
  tell_of_move("view", asked, start);
  auto rows = layer_rows(*scene, wanted, part, *opened);
  const std::vector<std::weak_ptr<GrowingCut>> growing(cuts.begin(), cuts.end());
  // From here on the globe alone owns what the layers read, so that removing a layer ends its work.
  opened.reset();
  cuts.clear();
  SceneOptions explored = options.scene;
  explored.base.body = scene->body;
  const ViewerOptions viewer_options{.camera = start,
                                     .print_camera = options.print_camera,
                                     .print_panels = options.print_panels,
                                     .cuts = growing,
                                     .layers = std::move(rows),
                                     .heights = scene->heights,
                                     .scene = explored,
                                     .map = wanted.map.value_or(options.kept.map && !wanted.unlit),
                                     .kept = options.kept,
                                     .units = options.units.value_or(options.kept.units),
                                     .hold_session = options.hold_session,
                                     .first_run = options.first_run,
                                     .flight = options.flight,
                                     .message = first_message(options, *scene),
                                     .open = options.open};
  Viewer viewer(window, *scene->globe, viewer_options);
  auto next = viewer.run();
  return Explored{.next = std::move(next), .scene = viewer.scene(), .units = viewer.units()};
}

/// The globe of a body as at the first start, in the window of a scene, with its limits: the included Earth, or no
/// picture.
SceneOptions new_scene(const SceneOptions& before, Viewport window, const Body& body) {
  SceneOptions scene;
  scene.size = window;
  scene.base = options_beside(before.base, {});
  scene.base.body = body;
  scene.base_look.shown = !are_two_bodies(earth(), body);
  scene.memory_mb = before.memory_mb;
  scene.surface.inner_sphere_srgb = kInnerSphere_srgb;
  return scene;
}

/// The scenes that bodies had in this run when the user left them, by the body's name.
using LeftScenes = std::map<std::string, SceneOptions>;

/// Goes on with a body as it was left: in this run, or in an earlier one.
void go_on_with(const Body& body, const LeftScenes& left, ViewOptions& options) {
  const auto known = left.find(body.name);
  if (known == left.end()) {
    if (options.kept.restore) (void)take_session(session_file(body), options, &body);
    return;
  }
  const Viewport window = options.scene.size;
  options.scene = known->second;
  options.scene.size = window;
  options.scene.leave_out_faulty = true;
}

/// The options for the scene that follows an explored one.
Result<ViewOptions> next_options(const ViewOptions& options, const NextScene& wanted, const Window& window,
                                 const LeftScenes& left) {
  ViewOptions next = options;
  next.scene = new_scene(options.scene, window.framebuffer(), wanted.body);
  next.full_screen = false;  // the window is as the user left it
  next.first_run = false;
  next.restored = next.hold_session = false;
  next.message.clear();
  next.flight.clear();
  next.open = wanted.layers;
  if (const auto file = settings_file()) next.kept = load_settings(*file).settings;
  if (!wanted.project.empty()) {
    next.scene.base.body.reset();
    if (const Status read = read_project(wanted.project, next.scene); !read) return read.error();
    return next;
  }
  if (!wanted.afresh) go_on_with(wanted.body, left, next);
  const bool bare = next.scene.base.address.empty() && are_two_bodies(earth(), wanted.body);
  if (bare && next.open.empty() && next.message.empty())
    next.message =
        fmt::format("There is no picture of {} yet; Ctrl + O opens one, E lists public ones", body_phrase(wanted.body));
  return next;
}

int view(ViewOptions options) {
  if (!options.scene.leave_out_faulty && !options.scene.project_fault) {
    if (const Status found = find_imagery(options.scene.base); !found) return fail("view", found.error().message);
  }
  // The window opens before the cutting, so that a missing display is reported at once.
  auto window = Window::create("Terrella", options.scene.size);
  if (!window) return fail("view", window.error().message);
  auto explored = explore(**window, options);
  if (!explored && options.restored && !StopSignals::came()) {  // the program starts in any case
    options.message = "The last session cannot be restored: " + explored.error().message;
    options.scene = new_scene(options.scene, (*window)->framebuffer(), earth());
    explored = explore(**window, options);
  }
  if (!explored) return fail("view", explored.error().message);
  LeftScenes left;
  while (explored->next) {
    NextScene& wanted = *explored->next;
    options.units = explored->units;
    const std::string left_body = explored->scene.base.body->name;
    options.hold_session ? (void)left.erase(left_body) : (void)left.insert_or_assign(left_body, explored->scene);
    auto next = next_options(options, wanted, **window, left);
    auto later = next ? explore(**window, *next) : Result<Explored>(next.error());
    if (!later && StopSignals::came()) return fail("view", later.error().message);
    if (!later && wanted.project.empty() && !std::exchange(wanted.afresh, true)) {  // a body opens in any case
      const auto file = session_file(wanted.body);
      std::error_code failed;
      const bool kept = next && next->kept.restore && file && std::filesystem::exists(*file, failed);
      const std::string why = later.error().message;
      next = next_options(options, wanted, **window, left);
      next->message = kept ? set_aside(*file, why) : why;
      next->hold_session = true;
      later = explore(**window, *next);
    }
    options = next ? *next : options;
    if (!later) {  // the scene before comes back
      options.scene = explored->scene;
      options.open.clear();
      options.message = later.error().message;
      later = explore(**window, options);
    }
    if (!later) return fail("view", later.error().message);
    explored = std::move(later);
  }
  return kDone;
}

}  // namespace

void add_view_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("view", "Explore a globe in a window");
  const auto options = std::make_shared<ViewOptions>();
  options->scene.size = kWindow;
  add_scene_options(*command, options->scene);
  command->get_option("--size")->default_str(fmt::format("{}x{}", kWindow.width_px, kWindow.height_px));
  command->add_flag("--print-camera", options->print_camera,
                    "Print the camera in the form of --camera to standard output each time the camera comes to rest");
  command->add_flag("--print-panels", options->print_panels,
                    "Print where panels and labels are, as JSON, to standard output each time this changes");
  command->get_option("--map")->default_str("on");
  command->add_flag("--fullscreen", options->full_screen, "Fill the screen; F returns to a window");
  command
      ->add_option("--flight", options->flight,
                   "Begin with the panel of this flight: GeoJSON, or the tours of a KML file")
      ->type_name("FILE");
  add_units_option(*command, options->units)->default_str("those of the last start, at first metric");
  command->footer(kHelpFooter);
  options->scene.surface.inner_sphere_srgb = kInnerSphere_srgb;
  command->callback([options, command, &exit_code] {
    begin_as_kept(*options, *command);
    exit_code = view(*options);
  });
}

}  // namespace terrella
