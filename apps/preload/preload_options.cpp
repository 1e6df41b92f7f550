#include "apps/preload/preload_options.h"

#include <fmt/format.h>

#include <cmath>

#include "apps/open_scene/options/option_checks.h"
#include "apps/open_scene/options/remote_set_options.h"
#include "apps/open_scene/options/shard_option.h"
#include "base/number.h"
#include "streaming/cut/output/tile_writer.h"
#include "tiles/tile_grid.h"

namespace terrella {
namespace {

Result<LevelRange> parse_levels(const std::string& text) {
  const std::size_t dash = text.find('-');
  const auto first = read_number(text.substr(0, dash));
  const auto last = dash == std::string::npos ? first : read_number(text.substr(dash + 1));
  const auto is_level = [](const std::optional<double>& n) {
    return n && *n >= 0 && *n <= kMaxTileLevel && *n == std::floor(*n);
  };
  if (!is_level(first) || !is_level(last) || *first > *last) {
    return Error{
        fmt::format("{} is no range of levels; write FIRST-LAST, as 0-8, in 0...{}", in_quotes(text), kMaxTileLevel)};
  }
  return LevelRange{static_cast<int>(*first), static_cast<int>(*last)};
}

Result<GeoRect> parse_box(const std::string& text) {
  std::vector<double> sides;
  const auto pieces = split_at_commas(text);
  for (const std::string_view piece : pieces) {
    if (const auto degrees = read_number(piece)) sides.push_back(*degrees);
  }
  if (sides.size() != 4 || pieces.size() != 4) {
    return Error{fmt::format("{} is not W,S,E,N; write four numbers in degrees, as 5,43,17,49", in_quotes(text))};
  }
  const bool on_planet = std::abs(sides[0]) <= 180.0 && std::abs(sides[2]) <= 180.0 && std::abs(sides[1]) <= 90.0 &&
                         std::abs(sides[3]) <= 90.0;
  if (!on_planet || sides[1] >= sides[3] || sides[0] == sides[2]) {
    return Error{fmt::format("{}: WEST and EAST take -180...180 (WEST > EAST crosses 180°), SOUTH < NORTH -90...90",
                             in_quotes(text))};
  }
  return GeoRect{.west = Angle::degrees(sides[0]),
                 .south = Angle::degrees(sides[1]),
                 .east = Angle::degrees(sides[2]),
                 .north = Angle::degrees(sides[3])};
}

void add_area_options(CLI::App& app, PreloadCommand& command) {
  app.add_option_function<std::string>(
         "--levels",
         [&command](const std::string& text) { command.levels = parsed_or_throw("--levels", parse_levels(text)); },
         "Set the tile levels, coarsest to finest (default: all of the set)")
      ->type_name("A-B");
  app.add_option_function<std::vector<std::string>>(
         "--bbox",
         [&command](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) {
             command.boxes.push_back(parsed_or_throw("--bbox", parse_box(text)));
           }
         },
         "Add a box in degrees; WEST > EAST crosses 180°. Repeatable")
      ->type_name("W,S,E,N")
      ->allow_extra_args(false);
  app.add_option("--polygon", command.polygons, "Add GeoJSON polygons; edges are great circles. Repeatable")
      ->type_name("F.geojson")
      ->allow_extra_args(false);
  app.add_option(
         "--flight", command.flight,
         "Load the tiles that the viewer would request along a flight: a GeoJSON LineString of eye positions and "
         "heights, or the tours of a KML file")
      ->type_name("F.geojson");
  app.add_option_function<std::string>(
         "--size", [&command](const std::string& text) { command.size = parsed_or_throw("--size", parse_size(text)); },
         "Set the viewer's window size for --flight (default: 1920x1080)")
      ->type_name("WxH");
  app.add_option_function<std::string>(
         "--shard",
         [&command](const std::string& text) { command.shard = parsed_or_throw("--shard", parse_shard(text)); },
         "Load only part I of N equal parts, for several machines; see terrella merge")
      ->type_name("I/N");
}

void add_times_option(CLI::App& app, PreloadCommand& command) {
  app.add_option(
         "--times", command.times,
         "Load these times of the layer, each into a file of its own: CACHE.2026-06-21.gpkg; A/B: all from A to "
         "B (default: one time, as --layer-time says)")
      ->type_name("A/B/P1D[,...]")
      ->delimiter(',')
      ->check(time_series())
      ->allow_extra_args(false);
}

void add_network_options(CLI::App& app, PreloadCommand& command) {
  app.add_option("--jobs", command.http.connections_per_host, "Limit the connections to one host")
      ->check(whole_number_in(1, 64))
      ->capture_default_str();
  app.add_option("--rate", command.http.rate_per_host,
                 "Limit the requests per second to one host, retries included (default: no limit)")
      ->check(number_in(0.01, 1e6));
  add_timeout_option(app, command.timeout_s, "Wait at most this many seconds for a server until the tiles are planned");
  app.add_option_function<int>(
         "--retries", [&command](int retries) { command.http.attempts = retries + 1; },
         "Retry a failed request this often, with growing pauses (default: 4)")
      ->check(whole_number_in(0, 19));
  app.add_option("--refresh-older-than", command.refresh_older_than_days,
                 "Refresh tiles older than this by conditional requests (default: refresh expired tiles)")
      ->type_name("DAYS")
      ->check(number_in(0.0, 36500.0));
  app.add_option("--ca-file", command.http.ca_file, "Trust these certificates instead of the system's")
      ->type_name("FILE");
}

}  // namespace

void add_preload_options(CLI::App& app, PreloadCommand& command) {
  app.add_option(
         "SOURCE", command.source,
         "A URL template, the address of a WMTS or WMS, a source description (JSON, <GDAL_WMS>), or a tile set on disk")
      ->required();
  app.add_option("-o,--output", command.output,
                 "Write tiles to this cache; an existing cache is extended. An MBTiles or a PMTiles file, for tiles in "
                 "Web Mercator, is made at the end, of a cache beside it")
      ->required()
      ->type_name("CACHE.gpkg|OUT.mbtiles|OUT.pmtiles");
  add_area_options(app, command);
  add_remote_set_options(app, command.remote);
  add_times_option(app, command);
  add_choice<Projection>(app, "--projection", command.remote.projection,
                         {{"equirectangular", Projection::equirectangular},
                          {"equal-area", Projection::equal_area},
                          {"web-mercator", Projection::web_mercator}},
                         "Set the projection of a URL template (default: equirectangular)");
  add_network_options(app, command);
  app.add_option(
         "--cache-size", command.cache_size_mb,
         "Limit the cache's size in MB; a larger plan is refused. Tiles left by viewers are evicted first, preloaded "
         "tiles never")
      ->type_name("MB")
      ->check(whole_number_in(1, 1L << 40));
  app.add_option("--missing", command.missing_file, "List the tiles that are missing in the end, and why")
      ->type_name("FILE");
  app.add_option("--stored", command.stored_file,
                 "Append each tile to FILE as LEVEL/X/Y once the tile is safely stored")
      ->type_name("FILE");
  app.add_flag("--dry-run", command.dry_run, "Estimate tiles, bytes (from a sample) and time; store nothing");
  app.add_flag("--release", command.release,
               "Unpin the plan's cached tiles, so that viewers with --cache-size may evict them; load nothing");
  app.add_flag("--offline", command.offline, "Take no sample, with --dry-run");
  app.add_flag("--json", command.json, "Print the result as one JSON object");
}

Status check_together(const PreloadCommand& command) {
  if (command.offline && !command.dry_run) {
    return Error{"--offline goes with --dry-run: without the network there is nothing to bring"};
  }
  if (!command.times.empty() && !command.remote.time.empty()) {
    return Error{"--times and --layer-time: one at a time"};
  }
  if (command.release && command.dry_run) return Error{"--release and --dry-run: one at a time"};
  if (!command.flight.empty() && (!command.boxes.empty() || !command.polygons.empty())) {
    return Error{"--flight and --bbox or --polygon: one at a time; the same cache takes both, one after the other"};
  }
  if (is_web_format(command.output)) {
    if (command.shard) {
      return Error{in_quotes(command.output) +
                   ": parts of --shard are joined by terrella merge, which takes caches; name an output that ends in "
                   ".gpkg, and merge the parts into this file"};
    }
    if (command.release || command.cache_size_mb > 0 || command.refresh_older_than_days) {
      return Error{in_quotes(command.output) +
                   ": --release, --cache-size and --refresh-older-than are for caches; name an output that ends in "
                   ".gpkg, and use terrella convert on it afterwards"};
    }
  } else if (!command.output.ends_with(".gpkg")) {
    return Error{in_quotes(command.output) + ": --output names a file that ends in .gpkg, .mbtiles or .pmtiles"};
  }
  return Done{};
}

}  // namespace terrella
