#include "apps/setup/scene_options.h"

#include <fmt/format.h>

#include <map>

#include "apps/commands/option_checks.h"
#include "apps/commands/remote_set_options.h"
#include "apps/setup/scene_overlays.h"
#include "sky/almanac.h"
#include "view/view_limits.h"

namespace terrella {
namespace {

void add_camera_options(CLI::App& command, SceneOptions& options) {
  command
      .add_option_function<std::string>(
          "--camera",
          [&options](const std::string& text) { options.camera = parsed_or_throw("--camera", parse_camera(text)); },
          "Where the eye is and looks: degrees and metres; straight down and 40 degrees of view unless said. ALT is "
          "over "
          "the ellipsoid: an eye in the ground, or under opaque ground without --objects, is put 1 m over it; at most "
          "as "
          "far out as the planet is a pixel wide")
      ->type_name("LAT,LON,ALT[,HEADING[,PITCH[,FOV]]]");
  command
      .add_option_function<std::string>(
          "--size", [&options](const std::string& text) { options.size = parsed_or_throw("--size", parse_size(text)); },
          "Picture size in pixels")
      ->type_name("WxH")
      ->default_str("1024x1024");
}

void add_planet_options(CLI::App& command, SceneOptions& options) {
  command
      .add_option_function<std::string>(
          "--body", [&options](const std::string& text) { options.body = parsed_or_throw("--body", parse_body(text)); },
          "The planet's figure: a name, or semi-major axis in metres and flattening")
      ->type_name("earth|moon|mars|sphere|A,F");
  add_choice<Projection>(command, "--projection", options.projection,
                         {{"equirectangular", Projection::equirectangular},
                          {"equal-area", Projection::equal_area},
                          {"web-mercator", Projection::web_mercator}},
                         "What the imagery's rows are linear in: latitude, its sine, or what web maps' are");
  add_choice<LatitudeKind>(command, "--latitude", options.latitude,
                           {{"graphic", LatitudeKind::graphic}, {"centric", LatitudeKind::centric}},
                           "Which latitude the imagery's rows count: planetographic or planetocentric");
}

void add_drawing_options(CLI::App& command, SceneOptions& options) {
  command.add_flag("--unlit", options.unlit, "Imagery alone: no light, no sky, black background, no text");
  add_choice<Texturing>(command, "--texturing", options.texturing,
                        {{"vertex", Texturing::vertex},
                         {"paper", Texturing::paper},
                         {"exact", Texturing::exact},
                         {"auto", Texturing::automatic}},
                        "How the pole bands are drawn")
      ->default_str("auto");
  command.add_option("--paper-a", options.paper_a, "Exponent a of --texturing paper")
      ->check(number_in(2.0, 8.0))
      ->capture_default_str();
  command
      .add_option("--band", options.band, "Width b of the pole bands of --texturing paper, as a part of the picture")
      ->check(number_in(0.001, 0.5))
      ->capture_default_str();
  add_choice<bool>(command, "--polar-rows", options.squeezed_rows, {{"squeezed", true}, {"full", false}},
                   "Tiles near the poles, of a set that terrella cut: squeezed ones, few, or those of the full grid")
      ->default_str("squeezed");
  command
      .add_option("--polar-columns", options.polar_columns,
                  "Of other sets: the tiles in a row that a patch touching a pole may lie on; it takes coarser ones "
                  "rather than more")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command
      .add_option("--detail", options.texels_per_pixel,
                  "Texels a pixel asked for: 1.4 shows a quarter less error for two thirds more tiles, 0.7 the reverse")
      ->check(number_in(0.125, 8.0))
      ->capture_default_str();
  add_choice<DepthMode>(
      command, "--depth", options.depth,
      {{"reversed", DepthMode::reversed}, {"log", DepthMode::logarithmic}, {"standard", DepthMode::standard}},
      "How depth is stored")
      ->default_str("reversed");
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
          "Imagery over the imagery, with its opacity from 0 to 1; where it is transparent or lacks, what lies below "
          "shows. May be given again")
      ->type_name("TILESET[:OPACITY]")
      ->allow_extra_args(false);
  add_choice<Projection>(command, "--overlay-projection", options.overlay_projection,
                         {{"equirectangular", Projection::equirectangular},
                          {"equal-area", Projection::equal_area},
                          {"web-mercator", Projection::web_mercator}},
                         "Of overlays that do not say it themselves, as URL templates do not");
}

void add_layer_options(CLI::App& command, SceneOptions& options) {
  command
      .add_option("--night", options.night,
                  "Imagery that shows where it is night at --time, by its own light; it fades through civil twilight")
      ->type_name("TILESET");
  command
      .add_option_function<std::string>(
          "--clouds",
          [&options](const std::string& text) { options.clouds = parsed_or_throw("--clouds", parse_overlay(text)); },
          "Imagery over all other, white on black, where black is clear; an opacity from 0 to 1 may follow")
      ->type_name("TILESET[:OPACITY]");
}

void add_relief_options(CLI::App& command, SceneOptions& options) {
  command
      .add_option("--elevation", options.elevation,
                  "Heights that raise the ground: a tile set of 16-bit heights, as terrella cut --elevation and GDAL's "
                  "gridded coverages are; or a JSON source description of heights on a server, with its \"elevation\"")
      ->type_name("TILESET");
  command.add_option("--exaggeration", options.exaggeration, "How many times as high heights are drawn")
      ->check(number_in(0.0, 100.0))
      ->capture_default_str();
}

void add_translucency_options(CLI::App& command, SceneOptions& options) {
  command.add_option("--surface-alpha", options.surface.alpha, "How opaque the surface is: 0 not at all, 1 wholly")
      ->check(number_in(0.0, 1.0))
      ->capture_default_str();
  add_choice<Blend>(command, "--blend", options.surface.blend,
                    {{"normal", Blend::normal}, {"additive", Blend::additive}},
                    "How a translucent surface goes over what lies under it")
      ->default_str("normal");
  command
      .add_option_function<std::string>(
          "--inner-sphere",
          [&options](const std::string& text) {
            options.surface.inner_sphere_below_m = parsed_or_throw("--inner-sphere", parse_length_or_off(text));
          },
          "How far under the equator the sphere lies that hides the far side of a translucent globe, metres (of Earth; "
          "in proportion on other bodies)")
      ->type_name("METRES_BELOW|off")
      ->default_str("1000000");
  add_choice<SurfaceFromBelow>(command, "--surface-from-below", options.surface.from_below,
                               {{"opaque", SurfaceFromBelow::opaque},
                                {"translucent", SurfaceFromBelow::translucent},
                                {"selective", SurfaceFromBelow::selective}},
                               "What an eye under the ground sees of the surface: selective lets through only objects "
                               "with through_surface")
      ->default_str("opaque");
  add_choice<HorizonCulling>(
      command, "--horizon-culling", options.surface.horizon_culling,
      {{"on", HorizonCulling::on}, {"off", HorizonCulling::off}, {"auto", HorizonCulling::automatic}},
      "Leave out what the planet hides; on: from under the ground also its other half")
      ->default_str("auto");
}

// The almanac's years are part of what the option takes.
Result<UtcTime> parse_time(std::string_view text) {
  Result<UtcTime> time = parse_utc(text);
  if (!time) return time;
  if (const Result<Almanac> almanac = almanac_at(*time); !almanac) {
    return Error{fmt::format("{}: {}", text, almanac.error().message)};
  }
  return time;
}

void add_sky_options(CLI::App& command, SceneOptions& options) {
  add_choice<bool>(command, "--sky", options.sky, {{"on", true}, {"off", false}}, "Stars, Sun, Moon and atmosphere")
      ->default_str("on");
  command
      .add_option_function<std::string>(
          "--time", [&options](const std::string& text) { options.time = parsed_or_throw("--time", parse_time(text)); },
          "Where Sun, Moon and stars stand, 1950 to 2050: for example 2026-06-21T12:00Z (default: light over the "
          "viewer's shoulder)")
      ->type_name("UTC");
  command.add_option("--objects", options.objects, "Points, lines and areas to draw, over and under the ground")
      ->type_name("F.geojson");
}

void add_stereo_options(CLI::App& command, SceneOptions& options) {
  add_choice<Stereo>(command, "--stereo", options.stereo.mode,
                     {{"off", Stereo::off},
                      {"side-by-side", Stereo::side_by_side},
                      {"interlaced", Stereo::interlaced},
                      {"anaglyph", Stereo::anaglyph}},
                     "Two eyes: the left one's picture left, in the even rows, or in red")
      ->default_str("off");
  command
      .add_option("--eye-separation", options.stereo.eye_separation_m,
                  "How far apart the eyes are, metres (default: a thirtieth of the distance to what is in the middle)")
      ->check(number_in(0.0, 1.0e9))
      ->type_name("METRES");
}

void add_cache_options(CLI::App& command, SceneOptions& options) {
  command
      .add_option(
          "--cache", options.cache,
          "Where tiles from a server are kept, and what a picture given as TILESET is cut into, to be found there the "
          "next time; heights from a server are kept beside FILE, in NAME-heights.gpkg; off: nowhere (default: "
          "$XDG_CACHE_HOME/terrella or ~/.cache/terrella)")
      ->type_name("FILE|off");
  command
      .add_option("--cache-size", options.cache_size_mb,
                  "Largest size of the file that tiles from a server are kept in, megabytes")
      ->check(whole_number_in(64, 1 << 24))
      ->type_name("MB")
      ->capture_default_str();
  command.add_option("--memory", options.memory_mb, "Memory for decoded tiles, megabytes")
      ->check(whole_number_in(64, 65536))
      ->type_name("MB")
      ->capture_default_str();
  command.add_flag("--offline", options.offline, "The cache alone: not one request leaves the machine");
}

}  // namespace

void add_scene_options(CLI::App& command, SceneOptions& options) {
  command
      .add_option("tileset", options.tile_set,
                  "A GeoPackage, a folder of tiles, a picture of the whole planet (JPEG, PNG, TIFF), a URL template "
                  "with {z}, {x} and {y}, the address of a WMTS's capabilities, or a JSON source description; "
                  "the Earth that the program carries unless given")
      ->type_name("TILESET");
  add_camera_options(command, options);
  add_planet_options(command, options);
  add_drawing_options(command, options);
  add_overlay_options(command, options);
  add_layer_options(command, options);
  add_relief_options(command, options);
  add_translucency_options(command, options);
  add_sky_options(command, options);
  add_stereo_options(command, options);
  add_cache_options(command, options);
  add_remote_set_options(command, options.remote);
}

Result<Body> scene_body(const SceneOptions& options, const TileSetInfo& info) {
  if (options.body) return *options.body;
  if (info.body.empty()) return earth();
  auto said = parse_body(info.body);
  if (!said) return Error{info.name + ": its description names the body '" + info.body + "': " + said.error().message};
  return said;
}

Camera first_camera(const SceneOptions& options, const Body& body, Viewport picture) {
  if (options.camera) return *options.camera;
  Camera camera;
  camera.eye = {.lat = Angle::degrees(20.0), .lon = Angle::degrees(0.0)};
  camera.eye.height_m = whole_globe_height_m(body.ellipsoid, camera.fov_y, picture);
  return camera;
}

GlobeOptions globe_options(const SceneOptions& options, const Body& body) {
  GlobeOptions globe;
  globe.body = body;
  globe.texturing = options.texturing;
  globe.paper_a = options.paper_a;
  globe.paper_band = options.band;
  globe.squeezed_rows = options.squeezed_rows;
  globe.polar_columns = options.polar_columns;
  globe.texels_per_pixel = options.texels_per_pixel;
  globe.depth = options.depth;
  globe.unlit = options.unlit;
  globe.surface = options.surface;
  globe.exaggeration = options.exaggeration;
  globe.sky = options.sky && !options.unlit;
  globe.time = options.time;
  globe.stereo = options.stereo;
  globe.gpu_bytes = options.memory_mb << 20;
  return globe;
}

}  // namespace terrella
