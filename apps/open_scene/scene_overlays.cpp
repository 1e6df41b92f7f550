#include "apps/open_scene/scene_overlays.h"

#include <fmt/format.h>

#include <utility>

#include "apps/open_scene/scene_numbers.h"
#include "base/number.h"

namespace terrella {

Result<OverlayOption> parse_overlay(const std::string& text) {
  OverlayOption overlay{.tile_set = text};
  if (const std::size_t colon = text.rfind(':'); colon != std::string::npos) {
    if (const auto opacity = read_number(std::string_view(text).substr(colon + 1))) {
      overlay = {.tile_set = text.substr(0, colon), .opacity = *opacity};
    }
  }
  if (overlay.tile_set.empty()) return Error{fmt::format("'{}' names no tile set", text)};
  if (!(overlay.opacity >= 0.0 && overlay.opacity <= 1.0)) {
    return Error{fmt::format("'{}': the opacity after the last colon must be from 0 to 1", Url(text).redacted())};
  }
  return overlay;
}

Result<std::vector<std::optional<NumberFacts>>> add_overlays(Globe& globe, const SceneOptions& options) {
  std::vector<std::optional<NumberFacts>> facts;
  for (const OverlayOption& overlay : options.overlays) {
    SceneOptions scene = options_beside(options, overlay.tile_set);
    scene.projection = options.overlay_projection;
    if (options.tile_set.empty()) scene.numbers = options.numbers;
    auto opened = open_layer(scene);
    if (!opened) return opened.error();
    opened->look.opacity = overlay.opacity;
    const auto layer = globe.add_imagery(opened->tiles, opened->look);
    if (!layer) return Error{overlay.tile_set.redacted() + ": " + layer.error().message};
    facts.push_back(std::move(opened->numbers));
  }
  return facts;
}

}  // namespace terrella
