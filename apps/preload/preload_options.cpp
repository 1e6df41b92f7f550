#include "apps/preload/preload_options.h"

#include "apps/open_scene/options/option_checks.h"
#include "apps/open_scene/options/remote_set_options.h"
#include "apps/open_scene/options/shard_option.h"
#include "streaming/cut/output/tile_writer.h"

namespace terrella {
namespace {

void add_place_options(CLI::App& app, PreloadCommand& command) {
  add_area_options(app, command.area);
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
  app.add_option_function<std::string>(
         "--between",
         [&command](const std::string& text) { command.between = parsed_or_throw("--between", parse_day_hours(text)); },
         "Request tiles only in this part of each day, and wait outside of it: local time, or UTC as 22:00-06:00Z. The "
         "source's description and the sample for --cache-size are requested at once")
      ->type_name("HH:MM-HH:MM[Z]");
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
  add_place_options(app, command);
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
  if (Status together = check_area(command.area); !together) return together;
  if (!command.flight.empty() && !command.area.is_planet()) {
    return Error{
        "--flight and --bbox, --polygon or --route: one at a time; the same cache takes both, one after the other"};
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
