#include "apps/program/scene_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "apps/film/light_sum.h"
#include "apps/open_scene/bounds_view.h"
#include "apps/open_scene/eye_place.h"
#include "apps/open_scene/scene_objects.h"
#include "apps/process/console.h"
#include "apps/process/process.h"
#include "apps/process/stop_signals.h"
#include "apps/program/missing_dates.h"
#include "apps/viewer/draw/drawing_file.h"
#include "apps/viewer/draw/drawing_scene.h"
#include "apps/viewer/panels/legend.h"
#include "apps/viewer/styles/class_legend.h"
#include "apps/viewer/tools/map_painter.h"
#include "apps/viewer/tools/picture_job.h"
#include "apps/viewer/tools/picture_ui.h"
#include "globe/experiments.h"
#include "render/gl/offscreen.h"

namespace terrella {
namespace {

constexpr std::size_t kMostReasons = 4;

/// Says where the data of a part of the planet lie; empty for a whole planet.
std::string where_they_lie(const std::optional<GeoRect>& part) {
  if (!part) return {};
  return fmt::format(
      "no data are in this view; they lie from {:.6g}° to {:.6g}° east and {:.6g}° to {:.6g}° north. "
      "Leave out --camera to look at them",
      part->west.deg(), part->east.deg(), part->south.deg(), part->north.deg());
}

/// Refuses a picture without any tile, which would look like the planet. A view beside the data only causes a remark.
Status check_some_came(const FrameStats& stats, const std::deque<MissingTile>& missing,
                       const std::optional<GeoRect>& part) {
  const std::string where = where_they_lie(part);
  if (stats.tiles_wanted == 0) {
    if (!where.empty()) print_message("{}\n", where);
    return Done{};
  }
  const auto is_absent = [](const MissingTile& tile) { return tile.failure.kind == MissingKind::absent; };
  if (stats.tiles_pending == 0 && !where.empty() && std::ranges::all_of(missing, is_absent)) {
    return Error{where + "; nothing was written"};
  }
  std::string message =
      fmt::format("none of the {} tiles of this picture came, nothing was written", stats.tiles_wanted);
  if (stats.tiles_pending > 0) message += "; --timeout gives them longer";
  for (std::size_t k = 0; k < std::min(missing.size(), kMostReasons); ++k)
    message += "\n  missing: " + name_of(missing[k]);
  return Error{message};
}

/// The size in which a picture is drawn.
Viewport drawn_size(const RenderCommand& command) {
  const Viewport size = command.scene.size;
  return {command.supersample * size.width_px, command.supersample * size.height_px};
}

/// Renders until settled or until the deadline, and checks for signals a few times a second.
/// With `heights_first`, imagery waits until all heights are there.
void wait_for_tiles(Globe& globe, unsigned framebuffer, Viewport size, std::chrono::steady_clock::time_point deadline,
                    bool heights_first) {
  constexpr std::chrono::milliseconds kBetweenLooks{200};
  const auto begun = std::chrono::steady_clock::now();
  const auto heights_until = begun + (deadline - begun) / 2;
  while (!StopSignals::came() && std::chrono::steady_clock::now() < deadline) {
    const auto until = std::min(deadline, std::chrono::steady_clock::now() + kBetweenLooks);
    if (heights_first) {
      const bool there = Experiments::settle_heights(globe, framebuffer, size, until);
      heights_first = !there && globe.status() && until < heights_until;
    } else if (globe.render_until_settled(framebuffer, size, until) || !globe.status()) {
      return;
    }
  }
}

/// Renders until all tiles are loaded or time is up. The eye rises with the ground as heights arrive.
void render_all(Globe& globe, const RenderCommand& command, const Camera& wanted, unsigned framebuffer,
                bool heights_first) {
  constexpr int kMostMoves = 4;  // finer heights move the ground less and less
  const auto limit = std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(command.scene.base.timeout_s));
  const auto deadline = std::chrono::steady_clock::now() + limit;
  const bool may_be_under = may_be_underground(command.scene);
  Camera camera = out_of_ground(wanted, 0.0, may_be_under);
  for (int move = 0; move < kMostMoves; ++move) {
    globe.set_camera(camera);
    wait_for_tiles(globe, framebuffer, drawn_size(command), deadline, heights_first);
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

Status check_drawn_side(const RenderCommand& command, int most_px) {
  const Viewport size = command.scene.size, drawn = drawn_size(command);
  if (std::max(drawn.width_px, drawn.height_px) <= most_px) return Done{};
  return Error{
      fmt::format("--supersample {} draws {}x{} pixels for a picture of {}x{}, and a side has at most {}: give "
                  "a smaller --supersample or --size",
                  command.supersample, drawn.width_px, drawn.height_px, size.width_px, size.height_px, most_px)};
}

/// The pixels of a picture, each as a square of `by` × `by`.
std::vector<std::uint8_t> enlarged(const Image& image, int by) {
  if (by == 1) return image.rgba;
  const auto width = static_cast<std::size_t>(image.width_px), times = static_cast<std::size_t>(by);
  std::vector<std::uint8_t> pixels(image.rgba.size() * times * times);
  for (std::size_t k = 0; k < pixels.size() / 4; ++k) {
    const std::size_t x = k % (width * times) / times, y = k / (width * times) / times;
    std::copy_n(&image.rgba[4 * (y * width + x)], 4, &pixels[4 * k]);
  }
  return pixels;
}

/// The classes of the objects and the layers of numbers, the highest first.
std::vector<LegendItem> legend_of(const OpenedScene& scene) {
  std::vector<LegendItem> items;
  for (auto at = scene.objects.rbegin(); at != scene.objects.rend(); ++at) {
    const auto classes = at->option.shown ? classes_of(at->style) : std::nullopt;
    if (classes) items.push_back(class_legend(std::filesystem::path(at->option.file).filename().string(), *classes));
  }
  for (auto at = scene.images.rbegin(); at != scene.images.rend(); ++at) {
    const SceneLayer& layer = *at;
    const auto look = layer.numbers ? scene.globe->look(layer.id) : Result<ImageLook>(Error{});
    if (!look || !look->numbers || !look->shown) continue;
    const std::string name = std::filesystem::path(layer.source.address.without_query()).filename().string();
    items.push_back({.title = legend_title(name, *layer.numbers), .unit = layer.numbers->unit, .look = *look->numbers});
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

GlobeOptions picture_options(const RenderCommand& command, const Body& body) {
  GlobeOptions options = globe_options(command.scene, body);
  // Intermediate frames are invisible, so all arrived tiles are uploaded at once.
  options.upload_bytes_per_frame = options.gpu_bytes;
  options.upload_time_per_frame = std::chrono::seconds(1);
  options.relief_meshes_per_frame = std::numeric_limits<int>::max();
  add_sky_data(options, options.time.has_value());
  if (command.more_objects || command.scene.has_objects()) add_label_font(options);
  return options;
}

}  // namespace

/// The globe is destroyed before the context.
struct ScenePicture::Parts {
  RenderCommand command;
  std::unique_ptr<HeadlessContext> context{};
  std::unique_ptr<MapPainter> map{};
  OpenedScene scene{};
  bool checked_fills = false;
  bool is_film = false;               ///< begin_frame() was called
  double own_alpha = 1.0;             ///< opacity of the surface at the first begin_frame()
  std::optional<UtcTime> own_time{};  ///< the same, time of the Sun
  bool keeps_features = false;        ///< show_features() was called
  std::unique_ptr<OffscreenTarget> target{};
  std::optional<std::optional<GeoRect>> part{};  ///< none: not looked up yet
  std::map<LayerId, PointClusters> clusters{};
  std::map<LayerId, ShownFeatures> shown{};

  Result<GlobeOptions> prepare(const Body& body);
  Status open();
  void check_fills();
  /// Shows features and clusters of objects as the globe's camera sees them.
  Status follow_view();
  Status add_drawings();
  /// The part of the planet with data, which takes a look at the tiles: once.
  const std::optional<GeoRect>& with_data();
  /// Renders a view without what is drawn over it.
  Result<FrameStats> render(const Camera& camera);
  [[nodiscard]] std::vector<std::string> attributions() const;
  [[nodiscard]] PictureOverlay overlay() const;
  Status draw_over(const PictureOverlay& overlay);
  /// The picture as it is drawn now, and what it was drawn from.
  Rendered read(const FrameStats& stats);
  [[nodiscard]] std::string where() const { return command.output.empty() ? "" : command.output + ": "; }
};

Result<GlobeOptions> ScenePicture::Parts::prepare(const Body& body) {
  if (Status room = check_drawing_memory(drawn_size(command)); !room) return room.error();
  Result<std::unique_ptr<HeadlessContext>> made = HeadlessContext::create();
  if (!made) return made.error();
  context = *std::move(made);
  if (command.supersample > 1) {
    if (Status fits = check_drawn_side(command, largest_picture_side_px()); !fits) return fits.error();
  }
  return picture_options(command, body);
}

Status ScenePicture::Parts::open() {
  if (const Status may = check_supersample(command); !may) return may.error();
  auto opened = open_scene(command.scene, [this](const Body& body) { return prepare(body); });
  if (!opened) return opened.error();
  scene = *std::move(opened);
  command.scene.base.body = scene.body;
  if (const Status drawn = add_drawings(); !drawn) return drawn.error();
  auto painter = open_map(command.scene, scene.body);
  if (!painter) return painter.error();
  map = *std::move(painter);
  target = std::make_unique<OffscreenTarget>(drawn_size(command));
  Experiments::of(*scene.globe).pixel_scale = command.supersample;
  return Done{};
}

/// Adds the user's marks of a project.
Status ScenePicture::Parts::add_drawings() {
  if (command.scene.drawings.empty()) return Done{};
  const auto marks = parse_drawing(command.scene.drawings, command.scene.project + ": \"drawings\"");
  if (!marks) return marks.error();
  for (const std::string& complaint : marks->complaints) print_message("{}\n", complaint);
  scene.all_objects = scene.all_objects && marks->complaints.empty();
  const auto added = scene.globe->add_objects(drawing_scene(marks->drawing, 1.0F));
  return added ? Status(Done{}) : added.error();
}

Status check_supersample(const RenderCommand& command) {
  if (command.supersample == 1) return Done{};
  if (command.scene.stereo.mode == Stereo::interlaced) {
    return Error{"--supersample would mix the rows of --stereo interlaced; leave out one of them"};
  }
  return check_drawn_side(command, kMaxSide_px);
}

std::vector<std::string> inputs_of(const SceneOptions& scene) {
  std::vector<std::string> inputs = {scene.objects, scene.project};
  for (const Url* url : {&scene.base.address, &scene.elevation, &scene.night, &scene.clouds.tile_set}) {
    inputs.push_back(url->with_secrets());
  }
  for (const OverlayOption& overlay : scene.overlays) inputs.push_back(overlay.tile_set.with_secrets());
  for (const LayerOption& layer : scene.layers) inputs.push_back(layer.source.address.with_secrets());
  for (const ObjectsOption& objects : scene.object_layers) inputs.push_back(objects.file);
  return inputs;
}

std::string name_of(const MissingTile& tile) {
  return fmt::format("{}/{}/{}: {}", tile.id.level, tile.id.x, tile.id.y, one_line(tile.failure.why));
}

Status check_clock(const SceneOptions& scene) {
  const LayerClock clock = scene.layer_clock.value_or(LayerClock::own);
  if (clock == LayerClock::own || scene.time) return Done{};
  return Error{"--layer-clock: there is no time to follow; give --time, or --flight with times"};
}

int heights_without(const FrameStats& stats) { return stats.heights_missing + stats.heights_pending; }

bool is_complete(const FrameStats& stats) {
  return stats.tiles_missing + stats.tiles_pending + heights_without(stats) == 0;
}

ScenePicture::ScenePicture(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
ScenePicture::~ScenePicture() = default;

Result<std::unique_ptr<ScenePicture>> ScenePicture::open(const RenderCommand& command) {
  auto parts = std::make_unique<Parts>(Parts{.command = command});
  if (const Status opened = parts->open(); !opened) return opened.error();
  std::unique_ptr<ScenePicture> picture(new ScenePicture(std::move(parts)));
  for (const SceneObjects& layer : picture->parts_->scene.objects) {
    const Status clustered = picture->set_clusters(layer.id, layer.points, layer.option.cluster_px);
    if (!clustered) return clustered.error();
    if (const Status shown = picture->set_shown(layer.id, layer.shown_when); !shown) return shown.error();
  }
  return picture;
}

Globe& ScenePicture::globe() { return *parts_->scene.globe; }
const OpenedScene& ScenePicture::scene() const { return parts_->scene; }

Result<LayerId> ScenePicture::add(const OverlayOption& overlay) {
  auto added = add_overlay(globe(), parts_->command.scene, overlay);
  if (!added) return added.error();
  parts_->scene.images.push_back(*std::move(added));
  return parts_->scene.images.back().id;
}

Camera ScenePicture::first_camera() const {
  const SceneOptions& said = parts_->command.scene;
  if (said.camera) return *said.camera;
  return default_camera(parts_->with_data(), parts_->scene.body.ellipsoid, said.size);
}

Status ScenePicture::set_clusters(LayerId layer, std::span<const ClusterPoint> points, double radius_px) {
  if (radius_px == 0.0) return Done{};
  Result<PointClusters> made = PointClusters::make(layer, points, radius_px);
  if (!made) return made.error();
  parts_->clusters.emplace(layer, *std::move(made));
  return Done{};
}

void ScenePicture::forget_features(LayerId layer) {
  parts_->clusters.erase(layer);
  parts_->shown.erase(layer);
}

Status ScenePicture::set_shown(LayerId layer, std::vector<ShownWhen> features) {
  if (const auto earlier = parts_->shown.find(layer); earlier != parts_->shown.end()) {
    Status ended = earlier->second.end(globe());
    parts_->shown.erase(earlier);
    if (!ended) return ended;
  }
  if (features.empty()) return Done{};
  Result<ShownFeatures> made = ShownFeatures::make(layer, std::move(features));
  if (!made) return made.error();
  parts_->shown.emplace(layer, *std::move(made));
  return Done{};
}

bool ScenePicture::has_all_objects() const { return parts_->scene.all_objects; }

const std::optional<GeoRect>& ScenePicture::Parts::with_data() {
  if (!part && scene.images.empty()) part.emplace();
  if (!part) part = part_with_data(scene.images.front().source.address, scene.base.grid.bounds);
  return *part;
}

Status ScenePicture::Parts::follow_view() {
  const std::vector<LayerId> layers = scene.globe->objects();
  const auto is_gone = [&](const auto& one) { return std::ranges::find(layers, one.first) == layers.end(); };
  std::erase_if(clusters, is_gone);
  std::erase_if(shown, is_gone);
  for (auto& [layer, features] : shown) {
    if (Status done = features.update(*scene.globe, command.scene.size); !done) return done;
  }
  for (auto& [layer, points] : clusters) {
    if (Status done = points.update(*scene.globe, command.scene.size); !done) return done;
  }
  return Done{};
}

/// Reports areas without a fill, once for all pictures.
void ScenePicture::Parts::check_fills() {
  if (std::exchange(checked_fills, true)) return;
  for (const LayerId layer : scene.globe->objects()) {
    const auto named = std::ranges::find(scene.objects, layer, &SceneObjects::id);
    const std::string file = named == scene.objects.end() ? std::string() : named->option.file;
    for (const std::string& complaint : fill_complaints(*scene.globe, layer, file)) {
      print_message("{}\n", complaint);
      scene.all_objects = false;
    }
  }
}

Status ScenePicture::begin_frame(std::optional<double> surface_alpha, std::optional<UtcTime> sun) {
  SceneOptions& said = parts_->command.scene;
  if (!std::exchange(parts_->is_film, true)) {
    parts_->own_alpha = said.surface.alpha;
    parts_->own_time = said.time;
  }
  const double alpha = surface_alpha.value_or(parts_->own_alpha);
  const std::optional<UtcTime> time = sun ? sun : parts_->own_time;
  Experiments::forget_imagery(globe());
  if (alpha != said.surface.alpha) {
    said.surface.alpha = alpha;
    globe().set_surface(said.surface);
  }
  if (time != said.time) {
    if (Status set = globe().set_time(time); !set) return set;
    said.time = time;
  }
  if (!parts_->scene.heights || !said.elevation_shown) return Done{};
  return globe().set_elevation(parts_->scene.heights);
}

Status ScenePicture::show_features(const Camera& camera) {
  globe().set_camera(camera);
  parts_->keeps_features = true;
  Experiments::of(globe()).layer_clock = parts_->command.scene.time;
  return parts_->follow_view();
}

Result<FrameStats> ScenePicture::Parts::render(const Camera& camera) {
  const Viewport size = drawn_size(command);
  const unsigned framebuffer = target->framebuffer();
  Globe& globe = *scene.globe;
  globe.set_camera(camera);
  if (!keeps_features) {
    if (const Status followed = follow_view(); !followed) return followed.error();
  }
  render_all(globe, command, camera, framebuffer, is_film);
  if (StopSignals::came()) return Error{where() + "stopped; no picture was written"};
  if (globe.needs_frame(framebuffer, size)) globe.render(framebuffer, size);
  FrameStats stats = globe.last_frame();
  if (const Status& drawn = globe.status(); !drawn) return drawn.error();
  check_fills();
  if (!stats.imagery_shown) {
    if (const Status some = check_some_came(stats, globe.missing_tiles(), with_data()); !some) return some.error();
  }
  return stats;
}

std::vector<std::string> ScenePicture::Parts::attributions() const {
  std::vector<std::string> thanks = scene.globe->attributions();
  if (map) thanks.insert(thanks.end(), map->attributions().begin(), map->attributions().end());
  return thanks;
}

PictureOverlay ScenePicture::Parts::overlay() const {
  PictureOverlay overlay{.graticule = command.scene.graticule.value_or(false), .map = map.get()};
  if (command.legend) overlay.legend = legend_of(scene);
  if (command.credits) overlay.credits = attributions();
  if (command.scale_bar) overlay.scale_units = command.units;
  return overlay;
}

Status ScenePicture::Parts::draw_over(const PictureOverlay& overlay) {
  const Status drawn =
      draw_over_picture(*scene.globe, target->framebuffer(), command.scene.size, overlay, command.supersample);
  return drawn ? Status(Done{}) : Error{where() + drawn.error().message};
}

Rendered ScenePicture::Parts::read(const FrameStats& stats) {
  const Viewport size = drawn_size(command);
  Image image{size.width_px, size.height_px, target->read()};
  if (command.supersample > 1) {
    LightSum light(command.scene.size, command.supersample);
    light.add(image);
    image = light.mean();
  }
  const auto time = keeps_features ? Experiments::of(*scene.globe).layer_clock : scene.globe->options().time;
  const auto &missing = scene.globe->missing_tiles(), &heights = scene.globe->missing_heights();
  return {.image = std::move(image),
          .stats = stats,
          .missing = {missing.begin(), missing.end()},
          .missing_heights = {heights.begin(), heights.end()},
          .missing_dates = missing_dates(scene, time),
          .attributions = attributions()};
}

Result<Rendered> ScenePicture::draw(const Camera& camera) {
  const auto stats = parts_->render(camera);
  if (!stats) return stats.error();
  if (const Status drawn = parts_->draw_over(parts_->overlay()); !drawn) return drawn.error();
  return parts_->read(*stats);
}

Result<Rendered> ScenePicture::draw_scene(const Camera& camera) {
  const auto stats = parts_->render(camera);
  if (!stats) return stats.error();
  return parts_->read(*stats);
}

Status ScenePicture::draw_over(const Camera& camera, Image& image) {
  const PictureOverlay overlay = parts_->overlay();
  if (overlay.empty()) return Done{};
  globe().set_camera(camera);
  parts_->target->write(enlarged(image, parts_->command.supersample));
  if (Status drawn = parts_->draw_over(overlay); !drawn) return drawn;
  image = parts_->read({}).image;
  return Done{};
}

}  // namespace terrella
