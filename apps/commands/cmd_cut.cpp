#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/open_scene/open_picture.h"
#include "apps/open_scene/open_remote_tiff.h"
#include "apps/open_scene/options/number_options.h"
#include "apps/open_scene/options/option_checks.h"
#include "apps/open_scene/options/place_options.h"
#include "apps/process/console.h"
#include "apps/process/progress.h"
#include "apps/process/stop_signals.h"
#include "apps/program/commands.h"
#include "base/number.h"
#include "geo/body.h"
#include "streaming/cut.h"
#include "streaming/cut/input/picture_place.h"
#include "streaming/mosaic/mosaic_list.h"
#include "streaming/raster/picture_kind.h"
#include "streaming/remote/web_address.h"

namespace terrella {
namespace {

constexpr const char* kCutExamples =
    "Examples:\n"
    "  terrella cut moon.jpg -o moon.gpkg --body moon\n"
    "  terrella cut alps.png -o tiles --bounds 5,43,17,49 --format png\n"
    "  terrella cut flight.tif -o flight.gpkg                           UTM, or any system that the file states\n"
    "  terrella cut earth.tif -o earth.pmtiles --grid webmercator       also .mbtiles, .gpkg or a folder\n"
    "  terrella cut https://host/mosaic.tif -o mosaic.gpkg\n"
    "  terrella cut flight.png -o flight.gpkg --crs EPSG:32633 --bounds 500000,4640000,506400,4650000\n"
    "  terrella cut world.200412.3x21600x21600.??.jpg -o earth.gpkg     NASA's eight parts as one\n"
    "  terrella cut nw.png ne.png sw.png se.png --mosaic 2x2 -o tiles\n"
    "  terrella cut etopo5.png --elevation --offset -32768 -o relief.gpkg\n"
    "  terrella cut temperature.tif -o temperature.gpkg                 numbers stay numbers\n"
    "  terrella cut landsat.tif --bands 4,3,2 --stretch percent:2,98 -o landsat.gpkg\n"
    "  terrella cut huge.tif -o huge.gpkg --shard 3/8                   on each of 8 machines, 1/8 to 8/8, then\n"
    "  terrella cut huge.tif -o huge.gpkg --join\n"
    "After an interruption the same command resumes and writes the same bytes.";

struct CutCommand {
  std::vector<std::string> images;
  std::string output;
  CutOptions cut;
  bool elevation = false;
  CutElevation heights;
  PlaceWords place;
  NumberOptions numbers;
  bool json = false;
};

/// Parses two whole numbers around a letter, such as 4x2 or 3/8.
Result<std::pair<int, int>> parse_pair(const std::string& text, char between, const char* wanted) {
  const std::size_t at = text.find(between);
  const auto first = read_number(std::string_view(text).substr(0, at));
  const auto second = at == std::string::npos ? std::nullopt : read_number(std::string_view(text).substr(at + 1));
  const auto is_count = [](double n) { return n >= 1.0 && n <= 100000.0 && n == std::floor(n); };
  const double a = first.value_or(0.0), b = second.value_or(0.0);
  if (is_count(a) && is_count(b)) return std::pair(static_cast<int>(a), static_cast<int>(b));
  return Error{fmt::format("{} is not {}", in_quotes(text), wanted)};
}

Result<CutShard> parse_cut_shard(const std::string& text) {
  const auto pair = parse_pair(text, '/', "I/N, as 3/8");
  if (!pair) return pair.error();
  if (pair->first > pair->second) return Error{fmt::format("{}: I is at most N", in_quotes(text))};
  return CutShard{.index = pair->first, .count = pair->second};
}

Result<MosaicGrid> parse_mosaic(const std::string& text) {
  const auto pair = parse_pair(text, 'x', "COLSxROWS, as 4x2");
  if (!pair) return pair.error();
  return MosaicGrid{.columns = pair->first, .rows = pair->second};
}

void print_summary(const CutCommand& command, const CutSummary& summary) {
  const TileGrid& grid = summary.grid;
  if (command.json) {
    const nlohmann::json result = {{"output", command.output},    {"tiles", summary.tiles},
                                   {"bytes", summary.bytes},      {"left_out", summary.left_out},
                                   {"tile_size", grid.tile_px},   {"root_span_deg", grid.root_span_deg},
                                   {"min_level", grid.min_level}, {"max_level", grid.max_level}};
    // Paths may contain bytes that are not UTF-8.
    print_result("{}\n", result.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  print_result("{}: {} tiles of {} pixels, levels {} to {}, {:.1f} MB\n", command.output, summary.tiles, grid.tile_px,
               grid.min_level, grid.max_level, static_cast<double>(summary.bytes) * 1e-6);
}

/// Replaces the address of a TIFF on a server by its raster.
Status open_address(CutCommand& command) {
  const auto is_address = [](const std::string& image) { return is_from_network(Url(image)); };
  if (std::ranges::none_of(command.images, is_address)) return Done{};
  const Url url(command.images.front());
  if (command.images.size() > 1) return Error{"an address is cut alone; download the parts of a picture first"};
  const auto tiff = open_remote_picture({.source = {.address = url}});
  if (!tiff) return tiff.error();
  set_raster(command.cut, *tiff);
  return Done{};
}

/// Opens the picture, if it is one raster. A fault is left to the cut, which names it.
void open_raster_of(CutCommand& command) {
  if (command.cut.picture || command.images.size() > 1) return;
  const std::filesystem::path image = command.images.front();
  if (picture_kind(image) != PictureKind::raster) return;
  if (const auto opened = measure_raster(image)) command.cut.picture = *opened;
}

/// True if a raster holds numbers, or one of a folder's or a list's; false if it cannot be read.
bool any_holds_numbers(const std::filesystem::path& input) {
  if (!is_mosaic(input)) return holds_numbers(input);
  const auto list = read_mosaic_list(input);
  return list && std::ranges::any_of(list->entries, [](const MosaicEntry& file) { return holds_numbers(file.path); });
}

/// Chooses the content to read from the pictures: heights, numbers or colours.
void set_reading(CutCommand& command) {
  if (command.elevation) {
    command.heights.nodata = command.numbers.nodata;
    command.cut.elevation = command.heights;
  } else {
    const auto& picture = command.cut.picture;
    set_numbers(command.cut, command.numbers,
                picture ? holds_numbers(*picture->raster) : any_holds_numbers(command.cut.images.front()));
  }
}

int run(CutCommand& command) {
  command.cut.images.assign(command.images.begin(), command.images.end());
  command.cut.output = command.output;
  set_place(command.cut, command.place);
  command.cut.remark = [](const std::string& remark) { print_message("terrella cut: {}\n", remark); };
  const StopSignals signals;
  if (Status opened = open_address(command); !opened) return fail("cut", opened.error().message);
  open_raster_of(command);
  if (command.cut.body.empty()) set_stated_body(command.cut);
  set_reading(command);
  Result<CutSummary> summary = Error{};
  {
    Progress progress("cutting " + command.cut.images.front().filename().string());
    command.cut.progress = [&](std::int64_t done, std::int64_t total) {
      progress.show(done, total);
      return !StopSignals::came();
    };
    summary = cut(command.cut);
  }
  if (!summary) return fail("cut", summary.error().message);
  print_summary(command, *summary);
  if (summary->left_out == 0) return kDone;
  print_message("terrella cut: {}: {} files are left out of it; the messages above name them\n", command.output,
                summary->left_out);
  return kDoneInPart;
}

void add_description_options(CLI::App& app, CutOptions& cut) {
  app.add_option_function<std::string>(
         "--body",
         [&cut](const std::string& text) {
           (void)parsed_or_throw("--body", parse_body(text));
           cut.body = text;
         },
         "Set the planet in the picture, by semi-major axis in metres and flattening, or by name: " + body_names() +
             ". Default: that of the picture's coordinate system, or the Earth. It is stored in the tile set")
      ->type_name("NAME|A,F");
  add_choice<Projection>(app, "--projection", cut.projection,
                         {{"equirectangular", Projection::equirectangular}, {"equal-area", Projection::equal_area}},
                         "Set the picture's projection; its rows are linear in latitude or in the sine of latitude");
  add_choice<LatitudeKind>(
      app, "--latitude", cut.latitude, {{"graphic", LatitudeKind::graphic}, {"centric", LatitudeKind::centric}},
      "Set the latitude that the picture's rows count: planetographic or planetocentric (default: as "
      "stated by the picture, else graphic)");
  app.add_option("--name", cut.name, "Set the tile set's name (default: the picture's file name)");
  app.add_option("--attribution", cut.attribution, "Set the attribution text shown with the picture");
}

void add_input_options(CLI::App& app, CutCommand& command) {
  CutOptions& cut = command.cut;
  add_place_options(app, command.place);
  app.add_option_function<std::string>(
         "--mosaic", [&cut](const std::string& text) { cut.mosaic = parsed_or_throw("--mosaic", parse_mosaic(text)); },
         "Join pictures given in rows from the north-west into a grid (default: by NASA's names A1 to D2, else by the "
         "bounds that each picture states)")
      ->type_name("COLSxROWS");
  CLI::Option* elevation =
      app.add_flag("--elevation", command.elevation, "Read the picture as heights and write 16-bit tiles");
  app.add_option(
         "--scale", command.heights.scale,
         "Set the scale in metres = number * scale + offset (default: 1; for Float32 by range, and from a server "
         "as Float32)")
      ->check(number_in(-kMostLength_m, kMostLength_m))
      ->needs(elevation);
  app.add_option("--offset", command.heights.offset, "Set the offset in metres (default: 0; for Float32 by range)")
      ->check(number_in(-kMostLength_m, kMostLength_m))
      ->needs(elevation);
  app.add_option("--nodata", command.numbers.nodata,
                 "Set the value for no data in a picture of heights or numbers that does not say it")
      ->check(any_number());
  app.add_option("--band", command.numbers.band,
                 "Keep the numbers of this band of a TIFF, counted from 1. Without it, gray TIFFs of 16 bits and more, "
                 "and of floats, keep their numbers, unless --format asks for pictures")
      ->check(whole_number_in(1, 65535))
      ->excludes(elevation);
  add_stretch_options(app, command.numbers);
  app.get_option("--bands")->excludes(elevation)->excludes("--band");
  app.get_option("--stretch")->needs("--bands");
}

void add_work_options(CLI::App& app, CutCommand& command) {
  CutOptions& cut = command.cut;
  app.add_option("--jobs", cut.jobs, "Set the number of threads that encode tiles; 0 means one per core")
      ->check(whole_number_in(0, 256))
      ->capture_default_str();
  CLI::Option* shard = app.add_option_function<std::string>(
      "--shard", [&cut](const std::string& text) { cut.shard = parsed_or_throw("--shard", parse_cut_shard(text)); },
      "Cut only part I of N into OUT.shard-I-of-N, for a later --join");
  shard->type_name("I/N");
  app.add_flag("--join", cut.join, "Write the output from all shards, then remove the shards")->excludes(shard);
  app.add_flag("--keep-shards", cut.keep_shards, "Leave the shards after --join, so that it may run again")
      ->needs("--join");
}

}  // namespace

void add_cut_command(CLI::App& app, int& exit_code) {
  CLI::App& sub = *app.add_subcommand("cut", "Cut a picture of a planet into a tile set");
  sub.footer(kCutExamples);
  const auto command = std::make_shared<CutCommand>();
  CutOptions& cut = command->cut;
  sub.add_option("image", command->images,
                 "A picture, the parts of one, a folder or list of rasters, or the address of a TIFF. Pictures are "
                 "JPEG, PNG, WebP, TIFF or BigTIFF")
      ->required()
      ->type_name("IMAGE...");
  sub.add_option(
         "-o,--output", command->output,
         "Write to a GeoPackage if the name ends in .gpkg, with --grid webmercator to MBTiles or PMTiles if the "
         "name ends in .mbtiles or .pmtiles, else to a folder")
      ->required()
      ->type_name("OUT.gpkg|OUT.mbtiles|OUT.pmtiles|DIR");
  add_choice<CutGrid>(sub, "--grid", cut.grid,
                      {{"geodetic", CutGrid::geodetic}, {"webmercator", CutGrid::web_mercator}},
                      "Set the grid of the tiles: geodetic keeps the picture's pixels, webmercator is the grid of web "
                      "maps (EPSG:3857), without latitudes beyond 85.05 degrees");
  sub.add_option("--tile-size", cut.tile_px, "Set the side of a tile in pixels, an even number")
      ->check(whole_number_in(16, 4096))
      ->check(CLI::Validator(
          [](const std::string& text) {
            return text.back() % 2 == 0 ? std::string() : text + " is odd; it takes an even number";
          },
          "even"))
      ->capture_default_str();
  sub.add_option("--quality", cut.quality, "Set the quality of JPEG and WebP tiles")
      ->check(whole_number_in(1, 100))
      ->capture_default_str();
  sub.add_option_function<std::string>(
         "--format",
         [&cut](const std::string& text) {
           const auto* const name = std::ranges::find(kImageFormatNames, text);
           cut.format = static_cast<ImageFormat>(name - kImageFormatNames.begin());
         },
         "Set the tile format (default: png if the picture has transparency, else jpg with png tiles at its outline)")
      ->check(CLI::IsMember(std::vector<std::string>(kImageFormatNames.begin(), kImageFormatNames.end())))
      ->type_name("jpg|png|webp");
  add_input_options(sub, *command);
  add_description_options(sub, cut);
  add_work_options(sub, *command);
  sub.add_flag("--force", cut.force, "Replace a tile set that was cut from other pictures; keep other files");
  sub.add_flag("--json", command->json, "Print the result as one JSON object");
  sub.callback([command, &exit_code] { exit_code = run(*command); });
}

}  // namespace terrella
