#include "apps/open_scene/options/surface_options.h"

#include <string>

#include "apps/open_scene/options/option_checks.h"
#include "streaming/objects/object_style.h"
#include "streaming/sets/elevation_json.h"

namespace terrella {
namespace {

Result<glm::vec3> parse_color(const std::string& text) {
  const auto color = read_color(text);
  if (!color) return Error{"'" + text + "' is no colour such as #102040"};
  return glm::vec3(color->red, color->green, color->blue) / 255.0F;
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
  add_choice<Blend>(command, "--blend", options.surface.blend,
                    {{"normal", Blend::normal}, {"additive", Blend::additive}},
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
      command, "--surface-from-below", options.surface.from_below,
      {{"opaque", SurfaceFromBelow::opaque},
       {"translucent", SurfaceFromBelow::translucent},
       {"selective", SurfaceFromBelow::selective}},
      "Choose how the surface looks from below; selective lets only objects with through_surface "
      "show through")
      ->default_str("opaque");
  add_choice<HorizonCulling>(
      command, "--horizon-culling", options.surface.horizon_culling,
      {{"on", HorizonCulling::on}, {"off", HorizonCulling::off}, {"auto", HorizonCulling::automatic}},
      "Skip what the planet hides; 'on' also skips the far half when the eye is under the ground")
      ->default_str("auto");
}

}  // namespace terrella
