#include "apps/open_scene/options/scene_options.h"

#include <fmt/format.h>

#include <cstdint>
#include <utility>

#include "apps/open_scene/options/option_checks.h"
#include "apps/open_scene/options/option_words.h"
#include "apps/open_scene/options/place_options.h"
#include "apps/open_scene/options/remote_set_options.h"
#include "apps/open_scene/options/surface_options.h"
#include "apps/open_scene/project/read_project.h"
#include "apps/process/data_dir.h"
#include "globe/experiments.h"
#include "globe/features/point_clusters.h"
#include "sky/almanac.h"

namespace terrella {

void add_row_options(CLI::App& command, SourceOptions& source) {
  add_choice<Projection>(
      command, "--projection", source.projection, projection_words(),
      "Set the imagery's projection; its rows are linear in latitude, in the sine of latitude, or as in web maps");
  add_choice<LatitudeKind>(command, "--latitude", source.latitude, latitude_words(),
                           "Set the latitude that the imagery's rows count: planetographic or planetocentric");
}

namespace {

void add_camera_options(CLI::App& command, SceneOptions& options) {
  command
      .add_option_function<std::string>(
          "--camera",
          [&options](const std::string& text) { options.camera = parsed_or_throw("--camera", parse_camera(text)); },
          "Set the eye's place and view, in degrees and metres; the default view is straight down, 40 degrees high. "
          "ALT "
          "is the height over the ellipsoid, at most where the planet is a pixel wide. An eye in the ground, or under "
          "opaque ground without --objects, moves to 1 m above it")
      ->type_name("LAT,LON,ALT[,HEADING[,PITCH[,FOV]]]");
  command
      .add_option_function<std::string>(
          "--size", [&options](const std::string& text) { options.size = parsed_or_throw("--size", parse_size(text)); },
          "Set the picture size in pixels")
      ->type_name("WxH")
      ->default_str("1024x1024");
}

void add_planet_options(CLI::App& command, SceneOptions& options) {
  command
      .add_option_function<std::string>(
          "--body",
          [&options](const std::string& text) { options.base.body = parsed_or_throw("--body", parse_body(text)); },
          "Set the planet's figure by semi-major axis in metres and flattening, or by name: " + body_names() +
              ". Default: what TILESET states, or the Earth")
      ->type_name("NAME|A,F");
  add_row_options(command, options.base);
}

void add_drawing_options(CLI::App& command, SceneOptions& options) {
  command.add_flag("--unlit", options.unlit, "Draw the imagery alone: no light, no sky, no text, black background");
  add_choice<Texturing>(command, "--texturing", options.texturing, texturing_words(),
                        "Choose the texturing of the pole bands")
      ->default_str("auto");
  command.add_option("--paper-a", options.paper_a, "Set the exponent a of --texturing paper")
      ->check(number_in(2.0, 8.0))
      ->capture_default_str();
  add_choice<bool>(
      command, "--polar-rows", options.squeezed_rows, {{"squeezed", true}, {"full", false}},
      "Choose the tiles near the poles in a set made by terrella cut: the few squeezed ones, or the full grid")
      ->default_str("squeezed");
  command
      .add_option(
          "--polar-columns", options.polar_columns,
          "Limit the tiles in a row under a patch that touches a pole, in sets not made by terrella cut; the patch "
          "uses coarser tiles instead of more")
      ->check(whole_number_in(1, 4096))
      ->capture_default_str();
  command
      .add_option("--detail", options.texels_per_pixel,
                  "Set the texels per pixel: 1.4 shows a quarter less error for two thirds more tiles, 0.7 the reverse")
      ->check(number_in(0.125, 8.0))
      ->capture_default_str();
  add_choice<Sharpness>(command, "--magnify", options.surface.sharpness, sharpness_words(),
                        "Choose the filter of imagery whose texels are larger than pixels; auto is bicubic, and "
                        "bilinear with --unlit")
      ->default_str("auto");
  add_choice<DepthMode>(command, "--depth", options.depth, depth_words(), "Choose the depth buffer's encoding")
      ->default_str("reversed");
}

// Parses a time and refuses years outside the almanac.
Result<UtcTime> parse_time(std::string_view text) {
  Result<UtcTime> time = parse_utc(text);
  if (!time) return time;
  if (const Result<Almanac> almanac = almanac_at(*time); !almanac) {
    return Error{fmt::format("{}: {}", text, almanac.error().message)};
  }
  return time;
}

void add_sky_options(CLI::App& command, SceneOptions& options) {
  add_choice<bool>(command, "--sky", options.sky, {{"on", true}, {"off", false}},
                   "Draw stars, Sun, Moon and atmosphere")
      ->default_str("on");
  add_choice<bool>(command, "--glint", options.surface.glint, {{"on", true}, {"off", false}},
                   "Draw the Sun's glint on the sea at --time")
      ->default_str("on");
  command
      .add_option_function<std::string>(
          "--time", [&options](const std::string& text) { options.time = parsed_or_throw("--time", parse_time(text)); },
          "Place Sun, Moon and stars for this time in 1950 to 2050, such as 2026-06-21T12:00Z (default: light over the "
          "viewer's shoulder)")
      ->type_name("UTC");
  add_choice<LayerClock>(
      command, "--layer-clock", options.layer_clock, clock_words(),
      "Choose the dates of layers that have several: their own, the last one at --time, or that one with the next "
      "date fading in over it. A flight with times and the window's time play them");
  add_choice<bool>(command, "--night-lights", options.night_lights, {{"on", true}, {"off", false}},
                   "Draw the lights of the Earth's cities on the night side at --time")
      ->default_str("on");
  CLI::Option* objects =
      command
          .add_option(
              "--objects", options.objects,
              "Draw points, lines and areas, over and under the ground: GeoJSON, KML, GPX, a shapefile, FlatGeobuf, "
              "GeoPackage or CSV")
          ->type_name("FILE");
  command
      .add_option(
          "--object-style", options.object_style,
          "Draw --objects in the style of this JSON file: colours, widths, sizes, texts and heights by the fields "
          "of features")
      ->type_name("FILE.json")
      ->needs(objects);
  command
      .add_option(
          "--cluster", options.cluster_px,
          "Draw points of --objects within this radius of one another, in pixels, as one disc with their number")
      ->check(number_in(PointClusters::kLeastRadius_px, PointClusters::kMostRadius_px))
      ->type_name("PX")
      ->needs(objects);
}

void add_map_options(CLI::App& command, SceneOptions& options) {
  add_choice<bool>(command, "--map", options.map, {{"on", true}, {"off", false}},
                   "Draw coastlines, borders, and names of countries and places of the Earth over the picture");
  command.add_flag_function(
      "--graticule", [&options](std::int64_t count) { options.graticule = count > 0; },
      "Draw lines of latitude and longitude with labels");
  command
      .add_option("--places", options.places,
                  "Take the names of places from this GeoJSON file of points with a name, on any body, instead of the "
                  "Earth's cities")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
}

void add_stereo_options(CLI::App& command, SceneOptions& options) {
  add_choice<Stereo>(command, "--stereo", options.stereo.mode, stereo_words(),
                     "Render for two eyes; the left eye's picture is on the left, in the even rows, or in red")
      ->default_str("off");
  command
      .add_option("--eye-separation", options.stereo.eye_separation_m,
                  "Set the distance between the eyes in metres (default: 1/30 of the distance to the picture's centre)")
      ->check(number_in(0.0, 1.0e9))
      ->type_name("METRES");
}

void add_cache_options(CLI::App& command, SceneOptions& options) {
  command
      .add_option("--cache", options.base.cache,
                  "Cache tiles from servers in FILE, and heights beside FILE in NAME-heights.gpkg. A picture given as "
                  "TILESET is "
                  "cut into the cache for later runs, but a tiled TIFF with overviews (COG) is read in place. 'off' "
                  "caches nothing (default: $XDG_CACHE_HOME/terrella or "
                  "~/.cache/terrella)")
      ->type_name("FILE|off");
  command
      .add_option("--cache-size", options.base.cache_size_mb,
                  "Limit the cache file for tiles from servers, in megabytes")
      ->check(whole_number_in(64, 1 << 24))
      ->type_name("MB")
      ->capture_default_str();
  command.add_option("--memory", options.memory_mb, "Limit the memory for decoded tiles, in megabytes")
      ->check(whole_number_in(64, 65536))
      ->type_name("MB")
      ->capture_default_str();
  command.add_flag("--offline", options.base.offline, "Use the cache alone and send no request");
}

}  // namespace

void add_scene_options(CLI::App& command, SceneOptions& options) {
  command
      .add_option(
          "tileset", options.base.address,
          "A project (.terrella), a GeoPackage, PMTiles, MBTiles, a folder of tiles, a picture (JPEG, PNG, WebP, TIFF) "
          "that states its "
          "place or shows the whole planet, a URL template with {z}, {x} and {y}, the address of a WMTS, a WMS or a "
          "TIFF, or "
          "a source description (JSON or <GDAL_WMS>) (default: the included Earth)")
      ->type_name("TILESET");
  add_camera_options(command, options);
  add_planet_options(command, options);
  add_place_options(command, options.base.place);
  add_number_options(command, options.base.numbers, options.band);
  add_drawing_options(command, options);
  add_overlay_options(command, options);
  add_layer_options(command, options);
  add_relief_options(command, options);
  add_translucency_options(command, options);
  add_sky_options(command, options);
  add_map_options(command, options);
  add_stereo_options(command, options);
  add_cache_options(command, options);
  add_remote_set_options(command, options.base.remote);
  command.get_option("--layer-clock")->excludes(command.get_option("--layer-time"));
  command.parse_complete_callback([&command, &options] {
    check_place(options.base.place);
    if (!is_project(options.base.address.with_secrets())) return;
    const Status read = read_project(command, options);
    if (!read) options.project_fault = read.error();
  });
}

void set_images(SceneOptions& options, std::vector<LayerOption> images) {
  const LayerOption lowest = images.empty() ? LayerOption{.source = {}, .look = {.shown = false}} : images.front();
  options.base = with_words(options.base, lowest.source);
  options.base_look = lowest.look;
  if (!images.empty()) images.erase(images.begin());
  options.layers = std::move(images);
}

constexpr const char* kReliefFile = "relief.gpkg";

Url included_relief() { return Url(data_file(kReliefFile).string()); }

bool is_included_relief(const Url& heights) {
  return std::filesystem::path(heights.with_secrets()).filename() == kReliefFile && heights == included_relief();
}

GlobeOptions globe_options(const SceneOptions& options, const Body& body) {
  GlobeOptions globe;
  globe.body = body;
  globe.texturing = options.texturing;
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

// A layer of small tiles has few bytes of slots in any driver; the default asks for no certain number.
std::string memory_note(std::size_t memory_mb, const FrameStats& stats) {
  if (stats.ground_left_out > 0) {
    return fmt::format("--memory {}: no room for lines and areas on {} squares of the ground; they are left out there",
                       memory_mb, stats.ground_left_out);
  }
  const std::size_t granted_mb = stats.gpu_bytes_granted >> 20;
  // Slots fill whole layers of an array.
  const bool is_less = memory_mb > SceneOptions().memory_mb && granted_mb < memory_mb - memory_mb / 100;
  if (stats.gpu_bytes_granted == 0 || (!is_less && !stats.gpu_memory_refused)) return {};
  return fmt::format(
      "--memory {}: the driver gives {} MB for tiles{}", memory_mb, granted_mb,
      stats.gpu_memory_refused ? ", and has no memory for more" : ", as many as its array textures hold");
}

std::string font_note(const FrameStats& stats) {
  if (stats.without_font.empty()) return {};
  constexpr std::size_t kMostTold = 8;
  std::string letters;
  for (const char32_t letter : stats.without_font.substr(0, kMostTold)) {
    letters += fmt::format("{}U+{:04X}", letters.empty() ? "" : ", ", static_cast<std::uint32_t>(letter));
  }
  return fmt::format("no font has the letters {}{} of labels: install one that has them, as fonts-noto does", letters,
                     stats.without_font.size() > kMostTold ? " and more" : "");
}

void set_paper_texturing(Globe& globe, const SceneOptions& options) {
  Experiments& experiments = Experiments::of(globe);
  experiments.paper_a = options.paper_a;
  experiments.paper_band = options.band;
}

}  // namespace terrella
