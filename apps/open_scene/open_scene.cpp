#include "apps/open_scene/open_scene.h"

#include <CLI/Error.hpp>
#include <utility>

#include "apps/open_scene/eye_place.h"
#include "apps/open_scene/open_imagery.h"
#include "apps/open_scene/scene_objects.h"
#include "apps/open_scene/swipe_sides.h"
#include "apps/process/console.h"
#include "streaming/georeference/figure.h"

namespace terrella {
namespace {

/// --body, else the tile set's body, else Earth.
Result<Body> scene_body(const SceneOptions& options, const TileSetInfo& info) {
  if (options.base.body) return *options.base.body;
  if (info.body.empty()) return earth();
  auto said = parse_body(info.body);
  if (!said) return Error{info.name + ": its description names the body '" + info.body + "': " + said.error().message};
  return said;
}

/// True for the globe of another body without pictures: its lowest one would be the included Earth, hidden.
bool is_bare(const SceneOptions& options) {
  const std::optional<Body>& body = options.base.body;
  return options.base.address.empty() && !options.base_look.shown && body && are_two_bodies(earth(), *body);
}

/// The included Earth ignores the options of numbers, which are its overlays'.
Result<ImageryLayer> open_base(SourceOptions base) {
  if (base.address.empty()) base.numbers = {};
  return open_layer(base);
}

/// Opens the layers of a scene one after another.
class SceneOpener {
 public:
  explicit SceneOpener(SceneOptions options) : options_(std::move(options)) {}

  Result<OpenedScene> open(const PrepareGlobe& prepare);

 private:
  Result<ImageryLayer> open_lowest();
  Status open_heights();
  Status make_globe(const GlobeOptions& options, ImageryLayer base);
  Status add_image(const SourceOptions& source, const ImageLook& look);
  Status add_pictures(const Url& address, const ImageLook& look);
  Status add_images();
  Status set_clocks();
  Status choose_sides();
  Status add_object_layers();
  void add_pictures_of_objects();
  Status leave_out(const Error& why);

  SceneOptions options_;
  OpenedScene scene_;
};

/// Reports a layer of a project that cannot be opened; any other is an error.
Status SceneOpener::leave_out(const Error& why) {
  if (!options_.leave_out_faulty) return why;
  scene_.left_out.push_back(why.message);
  print_message("{}; the layer is left out\n", why.message);
  return Done{};
}

// The lowest image of a project that can be opened is its base, at last the included Earth. A bare globe has no tiles.
Result<ImageryLayer> SceneOpener::open_lowest() {
  for (;;) {
    if (is_bare(options_)) return ImageryLayer{};
    auto base = open_base(options_.base);
    if (base || options_.base.address.empty()) return base;
    if (const Status left = leave_out(base.error()); !left) return left.error();
    const bool has_next = !options_.layers.empty();
    const bool on_earth = !options_.base.body || options_.base.body->name == earth().name;
    if (!has_next && !on_earth) {
      const std::string& name = options_.project.empty() ? options_.base.body->name : options_.project;
      return Error{name + ": none of its images can be opened"};
    }
    set_images(options_, std::exchange(options_.layers, {}));
    if (!has_next) options_.base_look = {};
  }
}

Status SceneOpener::open_heights() {
  auto heights = open_elevation(options_);
  if (!heights) return leave_out(heights.error());
  scene_.heights = *std::move(heights);
  return Done{};
}

Status SceneOpener::make_globe(const GlobeOptions& options, ImageryLayer base) {
  auto globe = Globe::create(options);
  if (!globe) return globe.error();
  scene_.globe = *std::move(globe);
  const auto heights = options_.elevation_shown ? scene_.heights : std::nullopt;
  if (Status raised = scene_.globe->set_elevation(heights); !raised) return raised;
  if (options.time) {
    if (Status lit = scene_.globe->set_night_lights(options_.night_lights); !lit) return lit;
  }
  if (!base.tiles) return Done{};
  ImageLook look = options_.base_look;
  look.numbers = base.look.numbers;
  const auto added = scene_.globe->add_imagery(base.tiles, look);
  if (!added) return added.error();
  scene_.images.push_back(
      {.id = *added, .numbers = std::move(base.numbers), .source = options_.base, .tiles = std::move(base.tiles)});
  return Done{};
}

Status SceneOpener::add_image(const SourceOptions& source, const ImageLook& look) {
  auto added = add_layer(*scene_.globe, source, look);
  if (!added) return leave_out(added.error());
  scene_.images.push_back(*std::move(added));
  return Done{};
}

Status SceneOpener::add_pictures(const Url& address, const ImageLook& look) {
  if (address.empty()) return Done{};
  const SourceOptions source = options_beside(options_.base, address);
  auto tiles = open_imagery(source);
  if (!tiles) return tiles.error();
  const auto added = scene_.globe->add_imagery(*tiles, look);
  if (!added) return added.error();
  scene_.images.push_back({.id = *added, .source = source, .tiles = *std::move(tiles)});
  return Done{};
}

/// The overlays, then --night, then --clouds, then the layers of a project.
Status SceneOpener::add_images() {
  for (OverlayOption overlay : options_.overlays) {
    overlay.blend = options_.overlay_blend;
    auto added = add_overlay(*scene_.globe, options_, overlay);
    if (!added) return added.error();
    scene_.images.push_back(*std::move(added));
  }
  if (Status night = add_pictures(options_.night, {.daylight = Daylight::night}); !night) return night;
  const OverlayOption& clouds = options_.clouds;
  const ImageLook as_clouds{
      .opacity = clouds.opacity, .alpha = AlphaFrom::brightness, .height_m = options_.cloud_height_m};
  if (Status above = add_pictures(clouds.tile_set, as_clouds); !above) return above;
  for (const LayerOption& layer : options_.layers) {
    const SourceOptions source = with_words(options_beside(options_.base, layer.source.address), layer.source);
    if (Status added = add_image(source, layer.look); !added) return added;
  }
  return Done{};
}

/// Gives all image layers the clock of --layer-clock.
Status SceneOpener::set_clocks() {
  if (!options_.layer_clock) return Done{};
  const auto has_dates = [](const SceneLayer& image) { return image.tiles && image.tiles->info().steps; };
  if (std::ranges::none_of(scene_.images, has_dates)) {
    print_message("terrella: --layer-clock does nothing: no layer has dates\n");
  }
  for (const SceneLayer& image : scene_.images) {
    Result<ImageLook> look = scene_.globe->look(image.id);
    if (!look) return look.error();
    look->clock = *options_.layer_clock;
    if (Status set = scene_.globe->set_look(image.id, *look); !set) return set;
  }
  return Done{};
}

/// Chooses the sides of --swipe.
Status SceneOpener::choose_sides() {
  if (!options_.surface.swipe) return Done{};
  std::vector<ImageLook> looks;
  looks.reserve(scene_.images.size());
  for (const SceneLayer& image : scene_.images) {
    const Result<ImageLook> look = scene_.globe->look(image.id);
    if (!look) return look.error();
    looks.push_back(*look);
  }
  if (!choose_swipe_sides(looks) && scene_.left_out.empty()) {
    return Error{"--swipe compares image layers, and only one is shown; add another one with --overlay"};
  }
  for (std::size_t i = 0; i < looks.size(); ++i) {
    if (Status set = scene_.globe->set_look(scene_.images[i].id, looks[i]); !set) return set;
  }
  return Done{};
}

/// Adds the pictures of the KML file of --objects. A project names them as an image.
void SceneOpener::add_pictures_of_objects() {
  auto added = add_layer(*scene_.globe, options_beside(options_.base, options_.objects), {});
  if (added) return scene_.images.push_back(*std::move(added));
  scene_.all_objects = false;
  print_message("{}\n", added.error().message);
}

Status SceneOpener::add_object_layers() {
  std::vector<ObjectsOption> layers = options_.object_layers;
  if (!options_.objects.empty())
    layers.insert(layers.begin(),
                  {.file = options_.objects, .style = options_.object_style, .cluster_px = options_.cluster_px});
  for (const ObjectsOption& option : layers) {
    auto added = add_objects(*scene_.globe, option, options_.keep_features);
    if (!added) {
      if (Status left = leave_out(added.error()); !left) return left;
      continue;
    }
    scene_.all_objects = scene_.all_objects && added->faultless;
    if (added->has_pictures && option.file == options_.objects) add_pictures_of_objects();
    scene_.objects.push_back(*std::move(added));
  }
  return Done{};
}

Result<OpenedScene> SceneOpener::open(const PrepareGlobe& prepare) {
  if (options_.project_fault) return *options_.project_fault;
  auto base = open_lowest();
  if (!base) return base.error();
  const auto body = base->tiles ? scene_body(options_, base->tiles->info()) : Result<Body>(*options_.base.body);
  if (!body) return body.error();
  options_.base.body = scene_.body = *body;
  if (base->tiles) scene_.base = base->tiles->info();
  if (const Status raised = open_heights(); !raised) return raised.error();
  if (const Status eye = check_eye(options_, *body, options_.size); !eye) {
    throw CLI::ValidationError("--camera", eye.error().message);
  }
  const auto prepared = prepare(*body);
  if (!prepared) return prepared.error();
  if (Status made = make_globe(*prepared, *std::move(base)); !made) return made.error();
  set_paper_texturing(*scene_.globe, options_);
  if (Status added = add_images(); !added) return added.error();
  if (Status set = set_clocks(); !set) return set.error();
  if (Status chosen = choose_sides(); !chosen) return chosen.error();
  if (Status added = add_object_layers(); !added) return added.error();
  scene_.all_objects = scene_.all_objects && scene_.left_out.empty();
  return std::move(scene_);
}

}  // namespace

Result<SceneLayer> add_layer(Globe& globe, const SourceOptions& source, const ImageLook& look) {
  auto opened = open_layer(source);
  if (!opened) return opened.error();
  ImageLook wanted = look;
  wanted.numbers = opened->look.numbers;
  const auto added = globe.add_imagery(opened->tiles, wanted);
  if (!added) return Error{source.address.redacted() + ": " + added.error().message};
  return SceneLayer{
      .id = *added, .numbers = std::move(opened->numbers), .source = source, .tiles = std::move(opened->tiles)};
}

Result<SceneLayer> add_overlay(Globe& globe, const SceneOptions& options, const OverlayOption& overlay) {
  SourceOptions source = options_beside(options.base, overlay.tile_set);
  source.projection = options.overlay_projection;
  if (options.base.address.empty()) source.numbers = options.base.numbers;
  return add_layer(globe, source, {.opacity = overlay.opacity, .blend = overlay.blend});
}

Result<OpenedScene> open_scene(SceneOptions options, const PrepareGlobe& prepare) {
  return SceneOpener(std::move(options)).open(prepare);
}

}  // namespace terrella
