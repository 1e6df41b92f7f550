#include <fmt/core.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>

#include "apps/commands/picture_report.h"
#include "apps/commands/tile_set_report.h"
#include "apps/commands/vector_report.h"
#include "apps/commands/verify_tiles.h"
#include "apps/open_scene/dated_files.h"
#include "apps/open_scene/open_imagery.h"
#include "apps/open_scene/open_remote_tiff.h"
#include "apps/open_scene/options/option_checks.h"
#include "apps/open_scene/options/place_options.h"
#include "apps/process/console.h"
#include "apps/process/stop_signals.h"
#include "apps/program/commands.h"
#include "streaming/cache/cache_report.h"
#include "streaming/objects/vector_objects.h"
#include "streaming/remote/describe_remote.h"
#include "streaming/sets/open_tile_set.h"
#include "tiles/tile_range.h"
#include "tiles/tile_source.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

struct InfoOptions {
  Url tile_set;
  PlaceWords place;
  DescribedBand band;
  bool verify = false;
  bool json = false;
  double timeout_s = 600.0;
};

constexpr const char* kInfoExamples =
    "Examples:\n"
    "  terrella info planet.gpkg             grid, levels, bounds, tiles, size\n"
    "  terrella info tiles/ --verify         decode every tile and name those that are broken\n"
    "  terrella info planet.gpkg --json      the same for a program to read\n"
    "  terrella info dem/                    a folder of rasters as one tile set: how many, and which are left out\n"
    "  terrella info roads.gpkg              a vector file's layers, features, fields and coordinate systems\n"
    "  terrella info moon.tif                a picture's stated place, and how the picture is shown or why not\n"
    "  terrella info https://host/moon.tif   the same of a TIFF on a server, by a few requests";

std::optional<std::uintmax_t> size_of(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) {
    const std::uintmax_t size = fs::file_size(path, error);
    return error ? std::nullopt : std::optional(size);
  }
  std::uintmax_t sum = 0;
  for (fs::recursive_directory_iterator entry(path, error), end; !error && entry != end && !StopSignals::came();
       entry.increment(error)) {
    std::error_code vanished;
    if (entry->is_regular_file(vanished)) sum += entry->file_size(vanished);
  }
  return error ? std::nullopt : std::optional(sum);
}

std::vector<LevelReport> count_levels(TileSource& source) {
  const TileGrid& grid = source.info().grid;
  std::vector<LevelReport> levels;
  for (int level = grid.min_level; level <= grid.max_level; ++level) {
    levels.push_back({level, tile_span_deg(grid, level), count_places(grid, level), source.count_tiles(level)});
  }
  return levels;
}

/// Prints a progress line to standard error about once a second; standard output carries only results. Stops on a
/// signal.
auto progress_lines() {
  return [last = std::chrono::steady_clock::now()](std::int64_t done, std::int64_t total) mutable {
    if (StopSignals::came()) return false;
    const auto now = std::chrono::steady_clock::now();
    if (now - last < std::chrono::seconds(1)) return true;
    last = now;
    print_message("{} of {} tiles read\n", done, total);
    return true;
  };
}

/// Checks tiles as stored. For a set in Web Mercator these are the original tiles, not the reprojected ones.
Result<VerifyReport> verify(const InfoOptions& options, std::shared_ptr<TileSource> source, bool is_cache) {
  if (source->info().made_of) {
    auto stored = open_stored_tile_set(options.tile_set.with_secrets());
    if (!stored) return stored.error();
    source = *std::move(stored);
  }
  Result<VerifyReport> verified = verify_tiles(source, progress_lines());
  if (!verified) return Error{options.tile_set.redacted() + ": " + verified.error().message};
  // A cache need not hold all tiles of its source.
  if (is_cache) verified->absent = 0;
  return verified;
}

int run_picture_info(const InfoOptions& options, const Result<PictureFacts>& facts) {
  if (!facts) return fail("info", facts.error().message);
  print_result("{}", picture_report(*facts, options.json));
  return kDone;
}

int run_vector_info(const InfoOptions& options, const fs::path& path) {
  if (options.verify) return fail("info", one_line(path.string()) + ": --verify checks tiles, and this file has none");
  const auto facts = describe_vector(path);
  if (!facts) return fail("info", facts.error().message);
  print_result("{}", vector_report(path, *facts, options.json));
  return kDone;
}

/// True for a file that holds features by its name. A GeoPackage or a folder may hold tiles instead.
bool holds_features(const fs::path& path) {
  std::error_code unknown;
  return fs::is_regular_file(path, unknown) && path.extension() != ".gpkg" && is_vector_file(path);
}

Result<PictureFacts> look_at_address(const InfoOptions& options) {
  const auto tiff = open_remote_picture({.source = {.address = options.tile_set}});
  const auto facts = tiff ? look_at(*tiff, options.place, options.band) : Result<PictureFacts>(tiff.error());
  return facts ? facts : Error{facts.error().message + WaitLimit::advice()};
}

/// The exit code for files that hold features, and for pictures, which are cut only for --verify. None for others.
std::optional<int> show_other_than_tiles(const InfoOptions& options, const std::string& path) {
  if (names_dated_files(options.tile_set)) return {};
  if (holds_features(path)) return run_vector_info(options, path);
  if (options.verify) return {};
  if (is_picture(path)) return run_picture_info(options, look_at(path, options.place, options.band));
  if (is_remote(options.tile_set) && leads_to_tiff(options.tile_set, {}, {})) {
    return run_picture_info(options, look_at_address(options));
  }
  return {};
}

int run_info(const InfoOptions& options) {
  const StopSignals signals;
  const WaitLimit limit(options.timeout_s);
  const std::string& path = options.tile_set.with_secrets();
  if (const auto shown = show_other_than_tiles(options, path)) return *shown;
  const Result<std::shared_ptr<TileSource>> source =
      open_any_tiles({.address = options.tile_set,
                      .place = options.place,
                      .numbers = {.nodata = options.band.nodata, .band = options.band.band},
                      .timeout_s = options.timeout_s});
  if (!source && fs::exists(path) && is_vector_file(path)) return run_vector_info(options, path);
  if (!source) return fail("info", source.error().message);
  TileSetReport report{
      .path = options.tile_set, .size_bytes = {}, .info = (*source)->info(), .levels = {}, .cache = {}, .verified = {}};
  report.size_bytes = size_of(path);
  report.levels = count_levels(**source);
  if (const auto* const mosaic = dynamic_cast<const MosaicTiles*>(source->get())) report.mosaic = mosaic->facts();
  if (StopSignals::came()) {
    return fail("info", options.tile_set.redacted() + ": stopped before its tiles were counted");
  }
  if (is_cache(path)) {
    const std::int64_t now_unix_s = std::time(nullptr);
    Result<CacheReport> cache = options.verify ? verify_cache(path, now_unix_s) : read_cache_report(path, now_unix_s);
    if (!cache) return fail("info", cache.error().message);
    report.cache = *std::move(cache);
  }
  if (options.verify) {
    Result<VerifyReport> verified = verify(options, *source, report.cache.has_value());
    if (!verified) return fail("info", verified.error().message);
    report.verified = *std::move(verified);
  }
  print_result("{}", options.json ? to_json(report) : to_text(report));
  const bool damaged = report.cache && report.cache->problems && !report.cache->problems->empty();
  if (damaged || (report.verified && report.verified->bad > 0)) return kFailed;
  return report.mosaic && report.mosaic->left_out > 0 ? kDoneInPart : kDone;
}

}  // namespace

void add_info_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("info", "Show a tile set's contents or a picture's georeference, and check them");
  command->footer(kInfoExamples);
  const auto options = std::make_shared<InfoOptions>();
  command
      ->add_option(
          "TILESET", options->tile_set,
          "A folder of tiles or of rasters, a GeoPackage, PMTiles, MBTiles, a picture, the address of a TIFF or a "
          "vector file")
      ->required();
  add_place_options(*command, options->place);
  command->add_option("--band", options->band.band, "Describe this band of a TIFF, counted from 1")
      ->check(whole_number_in(1, 65535));
  command->add_option("--nodata", options->band.nodata, "Set the value that means no data in a TIFF")
      ->check(any_number())
      ->type_name("VALUE");
  command->add_flag("--verify", options->verify,
                    "Decode every tile, name broken tiles, and check a cache's database; exit code 1 on any fault");
  add_timeout_option(*command, options->timeout_s, "Wait at most this many seconds for a server");
  command->add_flag("--json", options->json, "Print the result as one JSON object");
  command->callback([options, &exit_code] { exit_code = run_info(*options); });
}

}  // namespace terrella
