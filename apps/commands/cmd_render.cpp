#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/commands/commands.h"
#include "apps/commands/option_checks.h"
#include "apps/scene/scene_layers.h"
#include "apps/scene/scene_numbers.h"
#include "apps/scene/scene_objects.h"
#include "apps/scene/scene_options.h"
#include "apps/scene/scene_overlays.h"
#include "apps/setup/console.h"
#include "apps/setup/eye_place.h"
#include "apps/setup/open_imagery.h"
#include "apps/setup/open_rasters.h"
#include "apps/setup/process.h"
#include "apps/setup/stop_signals.h"
#include "apps/setup/write_file.h"
#include "apps/setup/write_picture.h"
#include "apps/viewer/panels/legend.h"
#include "apps/viewer/tools/map_painter.h"
#include "apps/viewer/tools/picture_ui.h"
#include "globe/globe.h"
#include "render/gl/offscreen.h"

namespace terrella {
namespace {

struct RenderCommand {
  SceneOptions scene;
  std::string output;
  double timeout_s = 600.0;
  bool json = false;
  bool legend = false;
  bool graticule = false;
  bool credits = false;
};

struct Rendered {
  FrameStats stats;
  std::vector<MissingTile> missing, missing_heights;
  std::vector<std::string> attributions;
  bool all_objects = true;  ///< true if the file of --objects has no faults
};

constexpr std::size_t kMostNamed = 16;
constexpr std::size_t kMostReasons = 4;

std::string name_of(const MissingTile& tile) {
  return fmt::format("{}/{}/{}: {}", tile.id.level, tile.id.x, tile.id.y, one_line(tile.failure.why));
}

/// Height tiles that failed or had not arrived at the deadline.
int heights_without(const FrameStats& stats) { return stats.heights_missing + stats.heights_pending; }

void report(const RenderCommand& command, const Rendered& rendered) {
  const FrameStats& stats = rendered.stats;
  const int got = stats.tiles_wanted - stats.tiles_missing - stats.tiles_pending;
  if (command.json) {
    nlohmann::json result = {{"output", command.output},
                             {"tiles_asked", stats.tiles_wanted},
                             {"tiles_got", got},
                             {"tiles_lacked", stats.tiles_missing + stats.tiles_pending},
                             {"patches", stats.patches},
                             {"band_patches", stats.band_patches},
                             {"draw_calls", stats.draw_calls},
                             {"triangles", stats.triangles},
                             {"attributions", rendered.attributions}};
    for (const MissingTile& tile : rendered.missing) result["lacking"].push_back(name_of(tile));
    if (!command.scene.elevation.empty()) result["heights_lacked"] = heights_without(stats);
    for (const MissingTile& tile : rendered.missing_heights) result["lacking_heights"].push_back(name_of(tile));
    print_result("{}\n", result.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  print_result("{}: {} tiles: {} loaded, {} missing\n", command.output, stats.tiles_wanted, got,
               stats.tiles_missing + stats.tiles_pending);
  if (!rendered.attributions.empty()) {
    print_result("{}: thanks to {}\n", command.output,
                 one_line(fmt::format("{}", fmt::join(rendered.attributions, "; "))));
  }
  if (heights_without(stats) > 0) {
    print_result("{}: {} tiles of heights missing\n", command.output, heights_without(stats));
  }
}

/// Refuses a picture without any tile, which would look like the planet.
Status check_some_came(const FrameStats& stats, const std::deque<MissingTile>& missing) {
  if (stats.tiles_wanted == 0 || stats.imagery_shown) return Done{};
  std::string message =
      fmt::format("none of the {} tiles of this picture came, nothing was written", stats.tiles_wanted);
  if (stats.tiles_pending > 0) message += "; --timeout gives them longer";
  for (std::size_t k = 0; k < std::min(missing.size(), kMostReasons); ++k)
    message += "\n  missing: " + name_of(missing[k]);
  return Error{message};
}

/// Renders until settled or until the deadline, and checks for signals a few times a second.
void wait_for_tiles(Globe& globe, unsigned framebuffer, Viewport size, std::chrono::steady_clock::time_point deadline) {
  constexpr std::chrono::milliseconds kBetweenLooks{200};
  while (!StopSignals::came() && std::chrono::steady_clock::now() < deadline) {
    const auto until = std::min(deadline, std::chrono::steady_clock::now() + kBetweenLooks);
    if (globe.render_until_settled(framebuffer, size, until) || !globe.status()) return;
  }
}

/// Renders until all tiles are loaded or time is up. The eye rises with the ground as heights arrive.
void render_all(Globe& globe, const RenderCommand& command, const Camera& wanted, unsigned framebuffer) {
  constexpr int kMostMoves = 4;  // finer heights move the ground less and less
  const auto limit =
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(command.timeout_s));
  const auto deadline = std::chrono::steady_clock::now() + limit;
  const bool may_be_under = may_be_underground(command.scene);
  Camera camera = out_of_ground(wanted, 0.0, may_be_under);
  for (int move = 0; move < kMostMoves; ++move) {
    globe.set_camera(camera);
    wait_for_tiles(globe, framebuffer, command.scene.size, deadline);
    camera = out_of_ground(wanted, globe.ground_height_m(wanted.eye.lat, wanted.eye.lon), may_be_under);
    if (camera.eye.height_m == globe.camera().eye.height_m) break;
  }
  tell_of_move("render", wanted, globe.camera());
}

/// Checks memory with a bound found by trials. Mesa's software driver and its compiler end the program when memory runs
/// out; limits up to 900 MB did so occasionally.
Status check_drawing_memory(Viewport size) {
  constexpr std::size_t kDriver_bytes = 1'200'000'000;
  constexpr std::size_t kBytesAPixel = 32;
  const std::size_t pixels = static_cast<std::size_t>(size.width_px) * static_cast<std::size_t>(size.height_px);
  return check_memory(kDriver_bytes + kBytesAPixel * pixels,
                      fmt::format("drawing {}x{} pixels", size.width_px, size.height_px));
}

std::vector<std::string> inputs_of(const SceneOptions& scene) {
  std::vector<std::string> inputs = {scene.objects};
  for (const Url* url : {&scene.tile_set, &scene.elevation, &scene.night, &scene.clouds.tile_set}) {
    inputs.push_back(url->with_secrets());
  }
  for (const OverlayOption& overlay : scene.overlays) inputs.push_back(overlay.tile_set.with_secrets());
  return inputs;
}

/// The layers of numbers, the highest first. Imagery has the order of add_overlays().
std::vector<LegendItem> legend_of(const Globe& globe, const SceneOptions& scene, const ImageryLayer& base,
                                  const std::vector<std::optional<NumberFacts>>& overlays) {
  std::vector<LegendItem> items;
  const std::vector<LayerId> ids = globe.imagery();
  for (std::size_t i = std::min(ids.size(), overlays.size() + 1); i-- > 0;) {
    const auto& facts = i == 0 ? base.numbers : overlays[i - 1];
    const auto look = globe.look(ids[i]);
    if (!facts || !look || !look->numbers) continue;
    const Url& named = i == 0 ? scene.tile_set : scene.overlays[i - 1].tile_set;
    const std::string name = std::filesystem::path(named.without_query()).stem().string();
    items.push_back({.title = legend_title(name, *facts), .unit = facts->unit, .look = *look->numbers});
  }
  return items;
}

/// Reads the map, if the picture gets one; else null.
Result<std::unique_ptr<MapPainter>> open_map(const SceneOptions& scene, const Body& body) {
  check_map(scene, body);
  if (!scene.map.value_or(!scene.places.empty())) return std::unique_ptr<MapPainter>();
  auto data = load_map(body, scene.places);
  if (!data) return data.error();
  return std::make_unique<MapPainter>(*std::move(data), body.ellipsoid);
}

Result<Rendered> render_picture(const RenderCommand& command) {
  const std::vector<std::string> inputs = inputs_of(command.scene);
  if (const Status may = may_write_picture(command.output, inputs); !may) return may.error();
  const Result<ImageryLayer> imagery = open_base(command.scene);
  if (!imagery) return imagery.error();
  const Result<Body> body = scene_body(command.scene, imagery->tiles->info());
  if (!body) return body.error();
  SceneOptions layers = command.scene;
  layers.body = *body;
  Result<std::optional<ElevationSource>> elevation = open_elevation(layers);
  if (!elevation) return elevation.error();
  if (const Status eye = check_eye(command.scene, *body, command.scene.size); !eye) {
    throw CLI::ValidationError("--camera", eye.error().message);
  }
  if (const Status room = check_drawing_memory(command.scene.size); !room) return room.error();
  const Result<std::unique_ptr<HeadlessContext>> context = HeadlessContext::create();
  if (!context) return context.error();
  GlobeOptions options = globe_options(command.scene, *body);
  // Intermediate frames are invisible, so all arrived tiles are uploaded at once.
  options.upload_bytes_per_frame = options.gpu_bytes;
  options.upload_time_per_frame = std::chrono::seconds(1);
  options.relief_meshes_per_frame = std::numeric_limits<int>::max();
  add_sky_data(options, options.time.has_value());
  if (!command.scene.objects.empty()) add_label_font(options);
  Result<std::unique_ptr<Globe>> globe = create_globe(options, *imagery, *std::move(elevation));
  if (!globe) return globe.error();
  set_paper_texturing(**globe, command.scene);
  const auto overlays = add_overlays(**globe, layers);
  if (!overlays) return overlays.error();
  if (const Status added = add_image_layers(**globe, layers); !added) return added.error();
  const Result<bool> objects = add_objects(**globe, command.scene);
  if (!objects) return objects.error();
  const auto map = open_map(command.scene, *body);
  if (!map) return map.error();
  const OffscreenTarget target(command.scene.size);
  render_all(**globe, command, first_camera(command.scene, *body, command.scene.size), target.framebuffer());
  if (StopSignals::came()) return Error{command.output + ": stopped; no picture was written"};
  if ((*globe)->needs_frame(target.framebuffer(), command.scene.size)) {
    (*globe)->render(target.framebuffer(), command.scene.size);
  }
  const FrameStats stats = (*globe)->last_frame();
  if (const Status& drawn = (*globe)->status(); !drawn) return drawn.error();
  if (const Status some = check_some_came(stats, (*globe)->missing_tiles()); !some) return some.error();
  std::vector<std::string> thanks = (*globe)->attributions();
  if (*map) thanks.insert(thanks.end(), (*map)->attributions().begin(), (*map)->attributions().end());
  PictureOverlay overlay{.graticule = command.graticule, .map = map->get()};
  if (command.legend) overlay.legend = legend_of(**globe, command.scene, *imagery, *overlays);
  if (command.credits) overlay.credits = thanks;
  if (const Status drawn = draw_over_picture(**globe, target.framebuffer(), command.scene.size, overlay); !drawn)
    return Error{command.output + ": " + drawn.error().message};
  // Rendering takes time; another file may have taken the name meanwhile.
  if (const Status may = may_write_picture(command.output, inputs); !may) return may.error();
  const Viewport size = command.scene.size;
  const Status written = write_picture(command.output, {size.width_px, size.height_px, target.read()});
  if (!written) return written.error();
  const auto& missing = (*globe)->missing_tiles();
  const auto& heights = (*globe)->missing_heights();
  return Rendered{stats, {missing.begin(), missing.end()}, {heights.begin(), heights.end()}, thanks, *objects};
}

int run(const RenderCommand& command) {
  const StopSignals signals;
  const Result<Rendered> rendered = render_picture(command);
  if (!rendered) {
    return fail("render", rendered.error().message);
  }
  report(command, *rendered);
  const FrameStats& stats = rendered->stats;
  if (stats.tiles_missing + stats.tiles_pending + heights_without(stats) == 0) {
    return rendered->all_objects && rasters_left_out() == 0 ? kDone : kDoneInPart;
  }
  for (std::size_t k = 0; k < std::min(rendered->missing.size(), kMostNamed); ++k) {
    print_message("terrella render: missing: {}\n", name_of(rendered->missing[k]));
  }
  for (std::size_t k = 0; k < std::min(rendered->missing_heights.size(), kMostNamed); ++k) {
    print_message("terrella render: {}: heights missing: {}; coarser heights are shown\n",
                  command.scene.elevation.redacted(), name_of(rendered->missing_heights[k]));
  }
  return kDoneInPart;
}

}  // namespace

void add_render_command(CLI::App& app, int& exit_code) {
  CLI::App& sub = *app.add_subcommand("render", "Render the globe to a PNG or JPEG file, without display or GPU");
  auto command = std::make_shared<RenderCommand>();
  add_scene_options(sub, command->scene);
  sub.add_option("-o,--output", command->output,
                 fmt::format("Write this file: a JPEG of quality {} if the name ends in .jpg or .jpeg, else a PNG",
                             kWrittenJpegQuality))
      ->required();
  sub.get_option("--map")->default_str("off, or on with --places");
  sub.get_option("--night")->needs(sub.get_option("--time"));  // without a time the whole globe is in daylight
  sub.add_option("--timeout", command->timeout_s, "Wait at most this many seconds for tiles")
      ->check(number_in(0.0, 1e6))
      ->capture_default_str();
  sub.add_flag("--legend", command->legend, "Draw a colour bar with units for each raster of numbers");
  sub.add_flag("--graticule", command->graticule, "Draw lines of latitude and longitude with labels");
  sub.add_flag("--credits", command->credits, "Write the sources of imagery and map into the upper right corner");
  sub.add_flag("--json", command->json, "Print the result as one JSON object");
  sub.footer("Example:\n  terrella render -o earth.png --size 1024x1024 --camera 46,7,3000000,0,-60");
  sub.callback([command, &exit_code] {
    if (const Status named = check_picture_name(command->output); !named) {
      throw CLI::ValidationError("--output", named.error().message);
    }
    exit_code = run(*command);
  });
}

}  // namespace terrella
