#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
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
#include "apps/open_scene/scene_objects.h"
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

LayerRow heights_row(const OpenedScene& scene, const Url& address, const OpenedRasters& opened) {
  return {.kind = LayerKind::heights,
          .name = shown_name(address.without_query()),
          .attribution = scene.heights->tiles()->info().attribution,
          .read_facts = facts_reader(address, {}, {}, opened)};
}

LayerRow image_row(const OpenedScene& scene, const SceneLayer& layer, const SourceOptions& base,
                   const OpenedRasters& opened) {
  const bool is_base = layer.id == scene.images.front().id;
  const Url address = layer.address.empty() ? Url(scene.base.name) : layer.address;
  const DescribedBand band{.band = base.numbers.band, .nodata = base.numbers.nodata};
  LayerRow row{.id = layer.id, .name = shown_name(address.without_query()), .numbers = layer.numbers};
  if (const auto look = scene.globe->look(layer.id)) row.look = *look;
  if (const auto attribution = scene.globe->attribution(layer.id)) row.attribution = *attribution;
  row.read_facts = facts_reader(address, is_base ? base.place : PlaceWords{}, band, opened);
  if (is_base) row.finest_level = scene.base.grid.max_level;
  return row;
}

/// The globe's layers: heights, imagery from bottom to top, objects.
std::vector<LayerRow> layer_rows(OpenedScene& scene, const SceneOptions& options, const std::optional<GeoRect>& part,
                                 const OpenedRasters& opened) {
  std::vector<LayerRow> rows;
  if (scene.heights) rows.push_back(heights_row(scene, options.elevation, opened));
  for (const SceneLayer& layer : scene.images) {
    rows.push_back(image_row(scene, layer, options.base, opened));
    if (layer.id == scene.images.front().id) rows.back().bounds = part;
  }
  for (const LayerId id : scene.globe->objects()) {
    rows.push_back({.id = id,
                    .kind = LayerKind::objects,
                    .name = std::filesystem::path(options.objects).filename().string(),
                    .bounds = {}});
    if (const auto attribution = scene.globe->attribution(id)) rows.back().attribution = *attribution;
    rows.back().style = style_of_layer(std::move(scene.objects.features));
  }
  return rows;
}

/// Puts the files of the command line into the list of recent files; the complaint if this fails.
std::string remember(const SceneOptions& scene) {
  std::vector<std::string> opened;
  std::vector<Url> urls = {scene.base.address};
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
  if (const Status found = find_imagery(options.scene.base); !found) return fail("view", found.error().message);
  // The window opens before the cutting, so that a missing display is reported at once.
  auto window = Window::create("Terrella", options.scene.size);
  if (!window) return fail("view", window.error().message);
  // Signals stop an unfinished cut cleanly; the window itself may be ended at any time.
  std::optional<StopSignals> signals(std::in_place);
  std::vector<std::shared_ptr<GrowingCut>> cuts;
  SceneOptions wanted = options.scene;
  wanted.base.cuts = &cuts;
  wanted.keep_features = true;
  auto opened = std::make_unique<OpenedRasters>();
  wanted.base.opened = opened.get();
  auto scene = open_scene(wanted, [&](const Body& body) -> Result<GlobeOptions> {
    check_map(options.scene, body);
    GlobeOptions with_sky = globe_options(options.scene, body);
    add_sky_data(with_sky, true);  // the user may choose a time
    add_label_font(with_sky);
    return with_sky;
  });
  if (!scene) return fail("view", scene.error().message);
  if (StopSignals::came()) return fail("view", "stopped");
  signals.reset();
  (*window)->show();
  if (options.full_screen) (*window)->toggle_full_screen();
  const auto part = part_with_data(options.scene.base.address, scene->base.grid.bounds);
  const Camera asked =
      options.scene.camera.value_or(default_camera(part, scene->body.ellipsoid, (*window)->framebuffer()));
  // Later heights raise the eye with the ground, as everywhere in the window.
  const Camera start = out_of_ground(asked, 0.0, may_be_underground(options.scene));
  tell_of_move("view", asked, start);
  auto rows = layer_rows(*scene, options.scene, part, *opened);
  const std::vector<std::weak_ptr<GrowingCut>> growing(cuts.begin(), cuts.end());
  // From here on the globe alone owns what the layers read, so that removing a layer ends its work.
  opened.reset();
  cuts.clear();
  SourceOptions files = options.scene.base;
  files.body = scene->body;
  const ViewerOptions viewer_options{.camera = start,
                                     .print_camera = options.print_camera,
                                     .print_panels = options.print_panels,
                                     .cuts = growing,
                                     .layers = std::move(rows),
                                     .heights = scene->heights,
                                     .places = options.scene.places,
                                     .files = files,
                                     .map = options.scene.map.value_or(options.kept.map && !options.scene.unlit),
                                     .kept = options.kept,
                                     .first_run = options.first_run,
                                     .message = options.message.empty() ? remember(options.scene) : options.message};
  Viewer(**window, *scene->globe, viewer_options).run();
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
