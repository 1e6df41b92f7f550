#include "apps/open_scene/open_scene.h"

#include <CLI/Error.hpp>
#include <utility>

#include "apps/open_scene/eye_place.h"
#include "apps/open_scene/open_imagery.h"
#include "apps/open_scene/scene_objects.h"

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

/// The included Earth ignores the options of numbers, which are its overlays'.
Result<ImageryLayer> open_base(SourceOptions base) {
  if (base.address.empty()) base.numbers = {};
  return open_layer(base);
}

Status add_layer(OpenedScene& scene, const SceneOptions& options, const Url& address, const ImageLook& look) {
  if (address.empty()) return Done{};
  auto tiles = open_imagery(options_beside(options.base, address));
  if (!tiles) return tiles.error();
  const auto added = scene.globe->add_imagery(*std::move(tiles), look);
  if (!added) return added.error();
  scene.images.push_back({.id = *added, .address = address});
  return Done{};
}

/// The overlays, then --night, then --clouds on top.
Status add_layers(OpenedScene& scene, const SceneOptions& options) {
  for (const OverlayOption& overlay : options.overlays) {
    auto added = add_overlay(*scene.globe, options, overlay);
    if (!added) return added.error();
    scene.images.push_back(*std::move(added));
  }
  if (Status night = add_layer(scene, options, options.night, {.daylight = Daylight::night}); !night) return night;
  return add_layer(
      scene, options, options.clouds.tile_set,
      {.opacity = options.clouds.opacity, .alpha = AlphaFrom::brightness, .height_m = options.cloud_height_m});
}

Status make_globe(OpenedScene& scene, const GlobeOptions& options, ImageryLayer base, const Url& address) {
  auto globe = Globe::create(options);
  if (!globe) return globe.error();
  scene.globe = *std::move(globe);
  if (Status raised = scene.globe->set_elevation(scene.heights); !raised) return raised;
  const auto added = scene.globe->add_imagery(std::move(base.tiles), base.look);
  if (!added) return added.error();
  scene.images.push_back({.id = *added, .address = address, .numbers = std::move(base.numbers)});
  return Done{};
}

}  // namespace

Result<SceneLayer> add_overlay(Globe& globe, const SceneOptions& options, const OverlayOption& overlay) {
  SourceOptions source = options_beside(options.base, overlay.tile_set);
  source.projection = options.overlay_projection;
  if (options.base.address.empty()) source.numbers = options.base.numbers;
  auto opened = open_layer(source);
  if (!opened) return opened.error();
  opened->look.opacity = overlay.opacity;
  const auto added = globe.add_imagery(opened->tiles, opened->look);
  if (!added) return Error{overlay.tile_set.redacted() + ": " + added.error().message};
  return SceneLayer{.id = *added, .address = overlay.tile_set, .numbers = std::move(opened->numbers)};
}

Result<OpenedScene> open_scene(SceneOptions options, const PrepareGlobe& prepare) {
  auto base = open_base(options.base);
  if (!base) return base.error();
  const auto body = scene_body(options, base->tiles->info());
  if (!body) return body.error();
  options.base.body = *body;
  OpenedScene scene{.body = *body, .base = base->tiles->info()};
  auto heights = open_elevation(options);
  if (!heights) return heights.error();
  scene.heights = *std::move(heights);
  if (const Status eye = check_eye(options, *body, options.size); !eye) {
    throw CLI::ValidationError("--camera", eye.error().message);
  }
  const auto prepared = prepare(*body);
  if (!prepared) return prepared.error();
  if (Status made = make_globe(scene, *prepared, *std::move(base), options.base.address); !made) return made.error();
  set_paper_texturing(*scene.globe, options);
  if (Status added = add_layers(scene, options); !added) return added.error();
  auto objects = add_objects(*scene.globe, options);
  if (!objects) return objects.error();
  scene.objects = *std::move(objects);
  return scene;
}

}  // namespace terrella
