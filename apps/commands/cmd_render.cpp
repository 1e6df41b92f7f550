#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/open_scene/open_rasters.h"
#include "apps/open_scene/options/option_checks.h"
#include "apps/open_scene/options/place_options.h"
#include "apps/open_scene/options/shard_option.h"
#include "apps/process/console.h"
#include "apps/process/stop_signals.h"
#include "apps/process/write_file.h"
#include "apps/process/write_picture.h"
#include "apps/program/commands.h"
#include "apps/program/film.h"
#include "apps/program/map_file.h"
#include "apps/program/scene_picture.h"
#include "apps/program/units_option.h"
#include "base/hash_mix.h"
#include "streaming/georeference/crs_text.h"

namespace terrella {
namespace {

constexpr std::size_t kMostNamed = 16;
constexpr long kMostSupersample = 4;
constexpr long kLeastMoments = 2, kMostMoments = 64;
constexpr const char* kPictureName = "picture name";  ///< name of the validator of --output
void report(const RenderCommand& command, const Rendered& rendered) {
  const FrameStats& stats = rendered.stats;
  const int got = stats.tiles_wanted - stats.tiles_missing - stats.tiles_pending;
  if (command.json) {
    nlohmann::json result = {{"output", command.output},
                             {"tiles_asked", stats.tiles_wanted},
                             {"tiles_got", got},
                             {"tiles_lacked", stats.tiles_missing + stats.tiles_pending},
                             {"patches", stats.patches},
                             {"band_patches", stats.band_patches},
                             {"draw_calls", stats.draw_calls},
                             {"triangles", stats.triangles},
                             {"attributions", rendered.attributions}};
    for (const MissingTile& tile : rendered.missing) result["lacking"].push_back(name_of(tile));
    if (!command.scene.elevation.empty()) result["heights_lacked"] = heights_without(stats);
    for (const MissingTile& tile : rendered.missing_heights) result["lacking_heights"].push_back(name_of(tile));
    print_result("{}\n", result.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  print_result("{}: {} tiles: {} loaded, {} missing\n", command.output, stats.tiles_wanted, got,
               stats.tiles_missing + stats.tiles_pending);
  thank(command.output, fmt::format("{}", fmt::join(rendered.attributions, "; ")));
  if (heights_without(stats) > 0) {
    print_result("{}: {} tiles of heights missing\n", command.output, heights_without(stats));
  }
}

/// Draws and writes the picture.
Result<Rendered> render_picture(const RenderCommand& command, bool& all_objects) {
  const std::vector<std::string> inputs = inputs_of(command.scene);
  const bool writes = !command.output.empty();
  if (const Status may = writes ? may_write_picture(command.output, inputs) : Done{}; !may) return may.error();
  if (const Status clock = check_clock(command.scene); !clock) return clock.error();
  const auto picture = ScenePicture::open(command);
  if (!picture) return picture.error();
  Result<Rendered> rendered = (*picture)->draw((*picture)->first_camera());
  all_objects = (*picture)->has_all_objects();
  if (!rendered || !writes) return rendered;
  // Rendering takes time; another file may have taken the name meanwhile.
  if (const Status may = may_write_picture(command.output, inputs); !may) return may.error();
  if (const Status written = write_picture(command.output, rendered->image); !written) return written.error();
  return rendered;
}

int tell_of_missing(const RenderCommand& command, const Rendered& rendered, bool all_objects) {
  const FrameStats& stats = rendered.stats;
  for (const std::string& note : {memory_note(command.scene.memory_mb, stats), font_note(stats)}) {
    if (!note.empty()) print_message("terrella render: {}\n", note);
  }
  for (const std::string& date : rendered.missing_dates) print_message("terrella render: {}\n", date);
  if (is_complete(stats) && rendered.missing_dates.empty()) {
    return all_objects && rasters_left_out() == 0 && stats.ground_left_out == 0 ? kDone : kDoneInPart;
  }
  for (std::size_t k = 0; k < std::min(rendered.missing.size(), kMostNamed); ++k) {
    print_message("terrella render: missing: {}\n", name_of(rendered.missing[k]));
  }
  for (std::size_t k = 0; k < std::min(rendered.missing_heights.size(), kMostNamed); ++k) {
    print_message("terrella render: {}: heights missing: {}; coarser heights are shown\n",
                  command.scene.elevation.redacted(), name_of(rendered.missing_heights[k]));
  }
  return kDoneInPart;
}

}  // namespace

int run_render(const RenderCommand& command, Image* image) {
  const StopSignals signals;
  bool all_objects = true;
  Result<Rendered> rendered = render_picture(command, all_objects);
  if (!rendered) return fail("render", rendered.error().message);
  report(command, *rendered);
  const int exit_code = tell_of_missing(command, *rendered, all_objects);
  if (image != nullptr) *image = std::move(rendered->image);
  return exit_code;
}

CLI::App& add_render_options(CLI::App& app, RenderCommand& command) {
  CLI::App& sub = *app.add_subcommand("render", "Render the globe to a PNG or JPEG file, without display or GPU");
  add_scene_options(sub, command.scene);
  sub.add_option("-o,--output", command.output,
                 fmt::format("Write this file: a JPEG of quality {} if the name ends in .jpg or .jpeg, else a PNG",
                             kWrittenJpegQuality))
      ->check(CLI::Validator(
          [](const std::string& name) {
            const Status named = check_picture_name(name);
            return named ? std::string() : named.error().message;
          },
          "", kPictureName));
  sub.get_option("--map")->default_str("off, or on with --places");
  sub.get_option("--night")->needs(sub.get_option("--time"));  // without a time the whole globe is in daylight
  add_timeout_option(sub, command.scene.base.timeout_s,
                     "Wait at most this many seconds for the description of a server's tiles, and as long for tiles");
  sub.add_flag("--legend", command.legend,
               "Draw a colour bar with units for each raster of numbers, and the classes of --object-style");
  sub.add_flag("--credits", command.credits, "Write the sources of imagery and map into the upper right corner");
  sub.add_flag("--scale-bar", command.scale_bar,
               "Draw a bar with a round length on the ground in the lower right corner");
  add_units_option(sub, command.units)->needs(sub.get_option("--scale-bar"))->default_str("metric");
  sub.add_option(
         "--supersample", command.supersample,
         "Draw this many times as wide and high and average in linear light, which smooths edges and fine detail")
      ->check(whole_number_in(1, kMostSupersample))
      ->capture_default_str();
  sub.add_flag("--json", command.json, "Print the result as one JSON object");
  sub.footer(
      "Examples:\n"
      "  terrella render -o earth.png --size 1024x1024 --camera 46,7,3000000,0,-60\n"
      "  terrella render -o frames/%05d.png --size 1920x1080 --flight alps.geojson --fps 25\n"
      "  terrella render -o arctic.tif --size 2048x2048 --extent=-4e6,-4e6,4e6,4e6 --crs EPSG:3413");
  return sub;
}

namespace {

/// Hashes of the options that decide the pixels of a film, by name. A file counts with its size and time.
FilmFacts facts_of(const CLI::App& sub) {
  constexpr std::array kOthers = {"--output", "--flight",  "--shard",      "--force",  "--json",
                                  "--cache",  "--timeout", "--cache-size", "--header", "--offline"};
  FilmFacts facts;
  for (const CLI::Option* option : sub.get_options()) {
    if (option->count() == 0 || std::ranges::find(kOthers, option->get_name()) != kOthers.end()) continue;
    std::string values;
    for (const std::string& value : option->results()) {
      values += value + '\n';
      std::error_code failed;
      if (!std::filesystem::is_regular_file(value, failed)) continue;
      values += fmt::format("{} {}\n", std::filesystem::file_size(value, failed),
                            std::filesystem::last_write_time(value, failed).time_since_epoch().count());
    }
    facts[option->get_name()] = fmt::format("{:016x}", name_hash(values));
  }
  return facts;
}

void add_film_options(CLI::App& sub, FilmCommand& film) {
  CLI::Option* flight =
      sub.add_option("--flight", film.flight,
                     "Render a film of a flight: a GeoJSON LineString of eye positions and heights, or the tours of a "
                     "KML file. -o names the frames as frames/%05d.png, or a film.mp4, which takes the program ffmpeg. "
                     "The same command goes on after "
                     "a kill, except with film.mp4")
          ->type_name("F.geojson");
  sub.add_option("--fps", film.fps, "Set the frames per second of --flight")
      ->check(number_in(1.0, 240.0))
      ->needs(flight)
      ->capture_default_str();
  sub.add_option_function<std::string>(
         "--shard", [&film](const std::string& text) { film.shard = parsed_or_throw("--shard", parse_shard(text)); },
         "Render only part I of N of the frames of --flight: every Nth one, for several machines")
      ->needs(flight)
      ->type_name("I/N");
  CLI::Option* blur =
      sub.add_option("--motion-blur", film.shutter,
                     "Average each frame of --flight, in linear light, over this part of its time, half of it before "
                     "and half after the frame's own. Cameras have 0.5; 0 is none")
          ->check(number_in(0.0, 1.0))
          ->needs(flight)
          ->capture_default_str();
  sub.add_option("--blur-moments", film.moments, "Draw this many moments of each frame for --motion-blur")
      ->check(whole_number_in(kLeastMoments, kMostMoments))
      ->needs(blur)
      ->capture_default_str();
  sub.add_flag("--force", film.force, "Replace the frames of another film, and render all frames of --flight anew")
      ->needs(flight);
}

void add_map_options(CLI::App& sub, MapCommand& map) {
  CLI::Option* extent =
      sub.add_option_function<std::string>(
             "--extent",
             [&map](const std::string& text) { map.extent = parsed_or_throw("--extent", parse_bounds(text)); },
             "Write a map of this extent as a GeoTIFF, in the system and the units of --crs, easting "
             "first. --size is the most that its sides have; its pixels are square. Images and "
             "numbers are drawn, without light, relief and objects")
          ->type_name("W,S,E,N");
  extent->needs(sub.get_option("--crs"));
}

/// Options that a map takes. All others describe a view of the globe.
void check_map_options(const CLI::App& sub) {
  constexpr std::array kOfMaps = {"tileset",      "--help",
                                  "--output",     "--extent",
                                  "--crs",        "--size",
                                  "--json",       "--layer",
                                  "--matrix-set", "--style",
                                  "--layer-time", "--layer-times",
                                  "--root-span",  "--tile-size",
                                  "--max-level",  "--header",
                                  "--timeout",    "--projection",
                                  "--latitude",   "--body",
                                  "--overlay",    "--overlay-projection",
                                  "--cache",      "--cache-size",
                                  "--offline",    "--west",
                                  "--nodata",     "--stretch",
                                  "--colormap",   "--band",
                                  "--bands",      "--unlit",
                                  "--slope",      "--overlay-blend"};
  for (const CLI::Option* option : sub.get_options()) {
    if (option->count() == 0 || std::ranges::find(kOfMaps, option->get_name()) != kOfMaps.end()) continue;
    throw CLI::ValidationError("render", fmt::format("--extent and {}: a map shows images and numbers as they are; "
                                                     "leave out {}",
                                                     option->get_name(), option->get_name()));
  }
}

int run_map_of(const CLI::App& sub, MapCommand& map, const RenderCommand& render) {
  check_map_options(sub);
  map.render = render;
  // The system is the map's; a picture that needs one is cut first.
  const std::string said = std::exchange(map.render.scene.base.place.crs, {});
  const auto named = stated_crs(said);
  map.crs = named ? *named : said;
  if (const Status together = check_together(map); !together) {
    throw CLI::ValidationError("render", together.error().message);
  }
  return run_map(map);
}

/// Renders a film, a map or a picture, as the command says.
int run_as_said(const CLI::App& sub, FilmCommand& film, MapCommand* map) {
  if (map != nullptr && sub.count("--extent") > 0) return run_map_of(sub, *map, film.render);
  if (const Status named = check_picture_name(film.render.output); !named) {
    throw CLI::ValidationError("--output",
                               named.error().message + (map != nullptr ? ", or with --extent a map as .tif" : ""));
  }
  if (const Status may = check_supersample(film.render); !may) {
    throw CLI::ValidationError("render", may.error().message);
  }
  if (film.flight.empty()) return run_render(film.render, nullptr);
  if (sub.count("--camera") > 0) {
    throw CLI::ValidationError("render", "--flight and --camera: the flight sets the view; leave out --camera");
  }
  if (const Status together = check_together(film); !together) {
    throw CLI::ValidationError("--output", together.error().message);
  }
  film.facts = facts_of(sub);
  return run_film(film);
}

/// `map`: null for a command that writes no maps.
CLI::App& add_render_and_film(CLI::App& app, int& exit_code, const std::shared_ptr<MapCommand>& map) {
  const auto film = std::make_shared<FilmCommand>();
  CLI::App& sub = add_render_options(app, film->render);
  add_film_options(sub, *film);
  if (map) add_map_options(sub, *map);
  sub.get_option("--output")->required()->get_validator(kPictureName)->active(false);
  sub.callback([film, map, &sub, &exit_code] { exit_code = run_as_said(sub, *film, map.get()); });
  return sub;
}

}  // namespace

void add_render_command(CLI::App& app, int& exit_code) {
  add_render_and_film(app, exit_code, std::make_shared<MapCommand>());
}

void add_film_command(CLI::App& app, int& exit_code) {
  CLI::App& sub = add_render_and_film(app, exit_code, nullptr);
  sub.description("Render a film of a flight, without display or GPU");
  sub.get_option("--flight")->required();
}

}  // namespace terrella
