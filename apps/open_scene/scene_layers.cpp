#include "apps/open_scene/scene_layers.h"

#include <memory>
#include <utility>

#include "apps/open_scene/open_imagery.h"

namespace terrella {
namespace {

Status add_layer(Globe& globe, const SceneOptions& options, const Url& tile_set, const ImageLook& look) {
  if (tile_set.empty()) return Done{};
  auto tiles = open_imagery(options_beside(options, tile_set));
  if (!tiles) return tiles.error();
  if (const auto added = globe.add_imagery(*std::move(tiles), look); !added) return added.error();
  return Done{};
}

}  // namespace

Status add_image_layers(Globe& globe, const SceneOptions& options) {
  if (Status night = add_layer(globe, options, options.night, {.daylight = Daylight::night}); !night) return night;
  return add_layer(
      globe, options, options.clouds.tile_set,
      {.opacity = options.clouds.opacity, .alpha = AlphaFrom::brightness, .height_m = options.cloud_height_m});
}

}  // namespace terrella
