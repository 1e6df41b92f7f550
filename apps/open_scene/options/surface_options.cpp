#include "apps/open_scene/options/surface_options.h"

#include <fmt/format.h>

#include <string>

#include "apps/open_scene/options/option_checks.h"
#include "apps/open_scene/options/option_words.h"
#include "base/number.h"
#include "streaming/objects/object_style.h"
#include "streaming/sets/elevation_json.h"

namespace terrella {
namespace {

Result<glm::vec3> parse_color(const std::string& text) {
  const auto color = read_color(text);
  if (!color) return Error{"'" + text + "' is no colour such as #102040"};
  return glm::vec3(color->red, color->green, color->blue) / 255.0F;
}

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

void add_relief_options(CLI::App& command, SceneOptions& options) {
  command
      .add_option("--elevation", options.elevation,
                  "Raise the ground by heights: a raster with one number a pixel in any coordinate system, the address "
                  "of such a "
                  "TIFF, a folder or list of rasters, a tile set made by terrella cut --elevation, or a GDAL gridded "
                  "coverage. A "
                  "JSON source description with \"elevation\" or \"encoding\" names tiles of heights on a server")
      ->type_name("RASTER|FOLDER|TILESET");
  command
      .add_option_function<std::string>(
          "--elevation-encoding",
          [&options](const std::string& name) { options.elevation_encoding = rgb_encoding(name); },
          "Read heights from the colours of the tiles of --elevation")
      ->check(CLI::IsMember({"terrain-rgb", "mapbox", "terrarium"}))
      ->type_name("terrain-rgb|terrarium")
      ->needs("--elevation");
  command
      .add_flag_callback(
          "--relief", [&options] { options.elevation = included_relief(); },
          "Raise the ground by the included heights of the Earth's land and sea floor, 10 km apart")
      ->excludes("--elevation");
  command.add_option("--exaggeration", options.exaggeration, "Multiply all drawn heights by this factor")
      ->check(number_in(0.0, 100.0))
      ->capture_default_str();
  command.add_flag("--hillshade", options.surface.hillshade,
                   "Shade the ground's relief by light from the north-west, as maps do, instead of by the Sun");
}

void add_translucency_options(CLI::App& command, SceneOptions& options) {
  command
      .add_option("--surface-alpha", options.surface.alpha, "Set the surface's opacity: 0 is invisible, 1 is opaque")
      ->check(number_in(0.0, 1.0))
      ->capture_default_str();
  add_choice<Blend>(command, "--blend", options.surface.blend, blend_words(),
                    "Choose how a translucent surface blends with what lies behind")
      ->default_str("normal");
  command
      .add_option_function<std::string>(
          "--inner-sphere",
          [&options](const std::string& text) {
            options.surface.inner_sphere_below_m = parsed_or_throw("--inner-sphere", parse_length_or_off(text));
          },
          "Set the depth in metres of the inner sphere under the equator. The sphere hides the far side of a "
          "translucent "
          "globe. The depth is for Earth and scales with other bodies")
      ->type_name("METRES_BELOW|off")
      ->default_str("1000000");
  command
      .add_option_function<std::string>(
          "--inner-sphere-color",
          [&options](const std::string& text) {
            options.surface.inner_sphere_srgb = parsed_or_throw("--inner-sphere-color", parse_color(text));
          },
          "Set the inner sphere's colour. Black hides the far side and adds nothing; other colours are shaded softly "
          "(default: black; in view dark blue)")
      ->type_name("#RRGGBB");
  add_choice<SurfaceFromBelow>(
      command, "--surface-from-below", options.surface.from_below, from_below_words(),
      "Choose how the surface looks from below; selective lets only objects with through_surface "
      "show through")
      ->default_str("opaque");
  add_choice<HorizonCulling>(
      command, "--horizon-culling", options.surface.horizon_culling, culling_words(),
      "Skip what the planet hides; 'on' also skips the far half when the eye is under the ground")
      ->default_str("auto");
}

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
  add_choice<Projection>(command, "--overlay-projection", options.overlay_projection, projection_words(),
                         "Set the projection of overlays that do not state it, such as URL templates");
  add_choice<LayerBlend>(command, "--overlay-blend", options.overlay_blend, layer_blend_words(),
                         "Choose how overlays combine with the layers below them")
      ->default_str("normal");
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
  command
      .add_option("--swipe", options.surface.swipe,
                  "Compare layers at a line, this fraction of the picture's width from the left: the topmost image "
                  "layer shows to its left, the next one to its right, and the lowest one under both")
      ->check(number_in(0.0, 1.0))
      ->type_name("0...1");
}

}  // namespace terrella
