#include "apps/open_scene/options/layer_options.h"

#include <fmt/format.h>

#include "apps/open_scene/options/option_checks.h"
#include "base/number.h"

namespace terrella {
namespace {

/// Reads "TILESET" or "TILESET:OPACITY", with an opacity in [0, 1]. Text after the last colon belongs to TILESET unless
/// the text is a number. The error names the text.
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

}  // namespace

void add_overlay_options(CLI::App& command, SceneOptions& options) {
  command
      .add_option_function<std::vector<std::string>>(
          "--overlay",
          [&options](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              options.overlays.push_back(parsed_or_throw("--overlay", parse_overlay(text)));
            }
          },
          "Add a layer of imagery on top, with an opacity from 0 to 1. Transparent pixels and missing tiles show the "
          "layer below. Repeatable")
      ->type_name("TILESET[:OPACITY]")
      ->allow_extra_args(false);
  add_choice<Projection>(command, "--overlay-projection", options.overlay_projection,
                         {{"equirectangular", Projection::equirectangular},
                          {"equal-area", Projection::equal_area},
                          {"web-mercator", Projection::web_mercator}},
                         "Set the projection of overlays that do not state it, such as URL templates");
}

void add_layer_options(CLI::App& command, SceneOptions& options) {
  command
      .add_option("--night", options.night,
                  "Add self-luminous imagery for the night side at --time; it fades in through civil twilight")
      ->type_name("TILESET");
  command
      .add_option_function<std::string>(
          "--clouds",
          [&options](const std::string& text) { options.clouds = parsed_or_throw("--clouds", parse_overlay(text)); },
          "Add white-on-black cloud imagery above all other layers; black is clear. The opacity is 0 to 1")
      ->type_name("TILESET[:OPACITY]");
  command
      .add_option("--cloud-height", options.cloud_height_m,
                  "Draw --clouds this many metres over the ground, with their shadow; at 0 they lie on the ground")
      ->check(number_in(0.0, 1.0e6))
      ->type_name("METRES")
      ->capture_default_str();
}

}  // namespace terrella
