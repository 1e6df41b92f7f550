#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/commands/raster_facts.h"
#include "apps/open_scene/eye_place.h"
#include "apps/open_scene/open_imagery.h"
#include "apps/open_scene/opened_rasters.h"
#include "apps/open_scene/options/scene_options.h"
#include "apps/open_scene/scene_layers.h"
#include "apps/open_scene/scene_numbers.h"
#include "apps/open_scene/scene_objects.h"
#include "apps/open_scene/scene_overlays.h"
#include "apps/process/console.h"
#include "apps/process/stop_signals.h"
#include "apps/program/commands.h"
#include "apps/viewer/tools/map_data.h"
#include "apps/viewer/tools/recent_files.h"
#include "apps/viewer/viewer.h"
#include "streaming/cut/growing/growing_cut.h"
#include "streaming/remote/describe_remote.h"

namespace terrella {
namespace {

constexpr Viewport kWindow{.width_px = 1280, .height_px = 800};
constexpr Viewport kSmallestWindow{.width_px = 320, .height_px = 240};  // lower bound for a kept size

constexpr const char* kHelpFooter =
    "Mouse: drag to move the ground, turn the wheel to zoom to the cursor, right-drag or Ctrl + drag to tilt and\n"
    "turn, double-click to fly there. Drop files onto the window, or press Ctrl + O, to add layers.\n"
    "Keys: arrows, + and - move; N north up, Home whole globe, R reset, G graticule, C map, F full screen,\n"
    "/ search, M measure, U translucent, X under the ground, B sky, T play the time, S stereo, P settings panel,\n"
    "L layers, I and F12 save pictures, 1 to 9 fly to bookmarks, F1 or ? shortcuts, Esc twice quits.\n"
    "\n"
    "Examples:\n"
    "  terrella view                                      the Earth\n"
    "  terrella view cog_of_any_size.tif                  shows at once, nothing is stored\n"
    "  terrella view moon.tif --body moon                 a picture of the whole Moon, also from 0 to 360 degrees\n"
    "  terrella view --overlay flight_in_utm.tif          a picture in any projection, over the Earth\n"
    "  terrella view earth.gpkg --camera 46,7,3e5,30,-20  the Alps from the south west";

// Dark, so that objects under the ground stand out, and bright enough to look round.
constexpr glm::vec3 kInnerSphere_srgb{0.22F, 0.28F, 0.38F};

struct ViewOptions {
  SceneOptions scene;
  bool print_camera = false;
  bool print_panels = false;
  bool full_screen = false;
  KeptSettings kept;
  bool first_run = false;
  std::string message;
};

// Applies the kept settings of earlier runs; options on the command line have priority.
void begin_as_kept(ViewOptions& options, const CLI::App& command) {
  const auto file = settings_file();
  if (!file) return;
  LoadedSettings loaded = load_settings(*file);
  options.first_run = loaded.first_run;
  options.message = std::move(loaded.complaint);
  const KeptSettings& kept = options.kept = loaded.settings;
  SceneOptions& scene = options.scene;
  if (command.count("--size") == 0 && kept.width_px > 0 && kept.height_px > 0) {
    scene.size = {std::max(kept.width_px, kSmallestWindow.width_px),
                  std::max(kept.height_px, kSmallestWindow.height_px)};
  }
}

LayerRow image_row(LayerId id, const Url& tile_set, const ImageLook& look) {
  return {.id = id, .name = shown_name(tile_set.without_query()), .bounds = {}, .look = look};
}

/// Rows in the order in which add_overlays(), add_image_layers() and add_objects() created the layers.
std::vector<LayerRow> layer_rows(const Globe& globe, const SceneOptions& scene, const ImageryLayer& base,
                                 const std::vector<std::optional<NumberFacts>>& overlays, const std::string& of_heights,
                                 const OpenedRasters& opened) {
  const TileSetInfo& first = base.tiles->info();
  std::vector<LayerRow> rows;
  if (globe.has_relief()) {
    LayerRow heights{.kind = LayerKind::heights, .name = shown_name(scene.elevation.without_query())};
    heights.attribution = of_heights;
    heights.read_facts = facts_reader(scene.elevation, {}, {}, opened);
    rows.push_back(std::move(heights));
  }
  std::vector<Url> names = {scene.tile_set.empty() ? Url(first.name) : scene.tile_set};
  for (const OverlayOption& overlay : scene.overlays) names.push_back(overlay.tile_set);
  if (!scene.night.empty()) names.push_back(scene.night);
  if (!scene.clouds.tile_set.empty()) names.push_back(scene.clouds.tile_set);
  const std::vector<LayerId> ids = globe.imagery();
  for (std::size_t i = 0; i < ids.size() && i < names.size(); ++i) {
    const auto look = globe.look(ids[i]);
    rows.push_back(image_row(ids[i], names[i], look ? *look : ImageLook{}));
    const DescribedBand band{.band = scene.numbers.band, .nodata = scene.numbers.nodata};
    rows.back().read_facts = facts_reader(names[i], i == 0 ? scene.place : PlaceWords{}, band, opened);
    if (const auto attribution = globe.attribution(ids[i])) rows.back().attribution = *attribution;
    rows.back().numbers = i == 0 ? base.numbers : i <= overlays.size() ? overlays[i - 1] : std::nullopt;
    if (i > 0) continue;
    rows.back().bounds = part_with_data(scene.tile_set, first.grid.bounds);
    rows.back().finest_level = first.grid.max_level;
  }
  for (const LayerId id : globe.objects()) {
    rows.push_back({.id = id,
                    .kind = LayerKind::objects,
                    .name = std::filesystem::path(scene.objects).filename().string(),
                    .bounds = {}});
    if (const auto attribution = globe.attribution(id)) rows.back().attribution = *attribution;
  }
  return rows;
}

/// Puts the files of the command line into the list of recent files; the complaint if this fails.
std::string remember(const SceneOptions& scene) {
  std::vector<std::string> opened;
  std::vector<Url> urls = {scene.tile_set};
  for (const OverlayOption& overlay : scene.overlays) urls.push_back(overlay.tile_set);
  urls.push_back(scene.elevation);
  opened.reserve(urls.size() + 1);
  for (const Url& url : urls) opened.push_back(url.with_secrets());
  opened.push_back(scene.objects);
  std::erase(opened, std::string());
  const Status kept = remember_opened(opened);
  return kept ? std::string() : kept.error().message;
}

int view(const ViewOptions& options) {
  if (const Status found = find_imagery(options.scene); !found) return fail("view", found.error().message);
  // The window opens before the cutting, so that a missing display is reported at once.
  auto window = Window::create("Terrella", options.scene.size);
  if (!window) return fail("view", window.error().message);
  // Signals stop an unfinished cut cleanly; the window itself may be ended at any time.
  std::optional<StopSignals> signals(std::in_place);
  std::vector<std::shared_ptr<GrowingCut>> cuts;
  SceneOptions layers = options.scene;
  layers.cuts = &cuts;
  auto opened = std::make_unique<OpenedRasters>();
  layers.opened = opened.get();
  auto imagery = open_base(layers);
  if (!imagery) return fail("view", imagery.error().message);
  const auto body = scene_body(options.scene, imagery->tiles->info());
  if (!body) return fail("view", body.error().message);
  layers.body = *body;
  auto elevation = open_elevation(layers);
  if (!elevation) return fail("view", elevation.error().message);
  if (const Status eye = check_eye(options.scene, *body, options.scene.size); !eye) {
    throw CLI::ValidationError("--camera", eye.error().message);
  }
  check_map(options.scene, *body);
  GlobeOptions globe_options_with_sky = globe_options(options.scene, *body);
  add_sky_data(globe_options_with_sky, true);  // the user may choose a time
  add_label_font(globe_options_with_sky);
  auto globe = create_globe(globe_options_with_sky, *imagery, *elevation);
  if (!globe) return fail("view", globe.error().message);
  set_paper_texturing(**globe, options.scene);
  const auto overlays = add_overlays(**globe, layers);
  if (!overlays) return fail("view", overlays.error().message);
  if (const Status added = add_image_layers(**globe, layers); !added) return fail("view", added.error().message);
  if (const Result<bool> added = add_objects(**globe, options.scene); !added)
    return fail("view", added.error().message);
  if (StopSignals::came()) return fail("view", "stopped");
  signals.reset();
  (*window)->show();
  if (options.full_screen) (*window)->toggle_full_screen();
  const Camera wanted =
      first_camera(options.scene, *body, imagery->tiles->info().grid.bounds, (*window)->framebuffer());
  // Later heights raise the eye with the ground, as everywhere in the window.
  const Camera start = out_of_ground(wanted, 0.0, may_be_underground(options.scene));
  tell_of_move("view", wanted, start);
  const std::string of_heights = *elevation ? (*elevation)->tiles()->info().attribution : std::string();
  auto rows = layer_rows(**globe, options.scene, *imagery, *overlays, of_heights, *opened);
  const std::vector<std::weak_ptr<GrowingCut>> growing(cuts.begin(), cuts.end());
  // From here on the globe alone owns what the layers read, so that removing a layer ends its work.
  layers.opened = nullptr;
  opened.reset();
  imagery->tiles.reset();
  cuts.clear();
  const ViewerOptions viewer_options{.camera = start,
                                     .print_camera = options.print_camera,
                                     .print_panels = options.print_panels,
                                     .cuts = growing,
                                     .layers = std::move(rows),
                                     .heights = *elevation,
                                     .places = options.scene.places,
                                     .files = layers,
                                     .map = options.scene.map.value_or(options.kept.map && !options.scene.unlit),
                                     .kept = options.kept,
                                     .first_run = options.first_run,
                                     .message = options.message.empty() ? remember(options.scene) : options.message};
  Viewer(**window, **globe, viewer_options).run();
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
  command->footer(kHelpFooter);
  options->scene.surface.inner_sphere_srgb = kInnerSphere_srgb;
  command->callback([options, command, &exit_code] {
    begin_as_kept(*options, *command);
    exit_code = view(*options);
  });
}

}  // namespace terrella
