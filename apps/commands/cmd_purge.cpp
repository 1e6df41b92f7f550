#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/open_scene/dated_files.h"
#include "apps/open_scene/options/option_checks.h"
#include "apps/open_scene/options/remote_set_options.h"
#include "apps/preload/preload_area.h"
#include "apps/preload/preload_progress.h"
#include "apps/preload/preload_times.h"
#include "apps/process/console.h"
#include "apps/process/stop_signals.h"
#include "apps/program/commands.h"
#include "streaming/cache/cache_report.h"
#include "streaming/cache/cache_schema.h"
#include "streaming/cache/purge_cache.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPurgeExamples =
    "Examples:\n"
    "  terrella purge alps.gpkg --levels 13-15 --dry-run           count, change nothing\n"
    "  terrella purge alps.gpkg --bbox 5,43,17,49 --older-than 90\n"
    "  terrella purge june.gpkg --times 2026-06-01/2026-06-10      in june.2026-06-01.gpkg and so on\n"
    "An area without --levels purges the tiles wholly within it; with --levels also those that reach beyond it.\n"
    "Pinned tiles are purged, too, except by --unused-for. The file's space is given back at once. What was purged can "
    "be preloaded again.";

struct PurgeCommand {
  std::vector<std::string> caches;
  PreloadArea area;
  std::vector<std::string> times;
  std::optional<double> older_than_days, unused_for_days;
  bool all = false;
  bool dry_run = false;
  bool json = false;
};

struct Purged {
  std::string cache;
  PurgeSummary summary;
};

Status check_purge(const PurgeCommand& command) {
  if (Status together = check_area(command.area); !together) return together;
  const bool some = !command.area.is_planet() || command.area.levels || command.older_than_days ||
                    command.unused_for_days || !command.times.empty();
  if (some && command.all) return Error{"--all purges every tile; omit it, or what else says which tiles"};
  if (!some && !command.all) {
    return Error{
        "state what to purge: an area, --levels, --times, --older-than or --unused-for; or --all, for every tile"};
  }
  return Done{};
}

/// The files beside a cache that hold its source at the times.
Result<std::vector<std::string>> files_of_times(const std::string& cache, const std::vector<std::string>& times) {
  const fs::path path(cache);
  const fs::path pattern = path.parent_path() / (path.stem().string() + ".{time}" + path.extension().string());
  const auto files = find_dated_files(pattern);
  if (!files) return Error{files.error().message + "; name the cache as preload -o did"};
  std::vector<std::string> there;
  there.reserve(files->size());
  for (const DatedFile& file : *files) there.push_back(file.time);
  if (there.empty()) return Error{pattern.string() + ": there is no such file; omit --times for a cache without times"};
  const auto steps =
      TimeSteps::parse(there, std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now()));
  if (!steps) return Error{pattern.string() + ": " + steps.error().message};
  const auto instants = named_instants(times, *steps);
  if (!instants) return Error{cache + ": " + instants.error().message};
  std::vector<std::string> wanted;
  for (const DatedFile& file : *files) {
    const auto named = read_named_time(file.time);
    if (named && std::ranges::binary_search(*instants, named->from)) wanted.push_back(file.file.string());
  }
  std::ranges::sort(wanted);
  return wanted;
}

std::optional<std::int64_t> days_ago(const std::optional<double>& days) {
  constexpr double kDay_s = 86400.0;
  if (!days) return std::nullopt;
  return std::int64_t{std::time(nullptr)} - static_cast<std::int64_t>(*days * kDay_s);
}

Result<PurgeSummary> purge_one(const PurgeCommand& command, const std::string& cache) {
  PurgeWish wish{.stored_before_unix_s = days_ago(command.older_than_days),
                 .used_before_unix_s = days_ago(command.unused_for_days),
                 .dry_run = command.dry_run,
                 .goes_on = [] { return !StopSignals::came(); }};
  std::shared_ptr<const TilePlan> plan;
  std::unique_ptr<TileFeed> feed;
  if (!command.area.is_planet() || command.area.levels) {
    const auto report = read_cache_report(cache, std::time(nullptr));
    if (!report) return report.error();
    if (report->source_key.starts_with(kRangesKey)) {
      return Error{cache +
                   ": holds parts of one file, not tiles of places; purge it by --older-than, --unused-for or "
                   "--all"};
    }
    const TileRule rule = command.area.levels ? TileRule::overlapping : TileRule::inside;
    auto planned = plan_area(command.area, report->info, cache, rule);
    if (!planned) return planned.error();
    if ((*planned)->total() == 0) {
      return Error{cache + (command.area.levels ? ": no tile of these levels lies in the area"
                                                : ": no tile lies wholly within the area; with --levels those that "
                                                  "reach beyond it go, too")};
    }
    plan = *std::move(planned);
    feed = plan->walk();
    wish.next_places = [&feed]() -> std::optional<PurgeRun> {
      const auto run = feed->next();
      if (!run) return std::nullopt;
      return PurgeRun{.level = run->level, .x = run->x, .first_y = run->first_y, .last_y = run->last_y};
    };
  }
  return purge_cache(cache, wish);
}

std::string purge_text(const Purged& purged, bool dry_run) {
  const PurgeSummary& s = purged.summary;
  const std::string what = fmt::format("{} tiles ({}) and {} records of missing tiles", s.tiles,
                                       bytes_text(double(s.tile_bytes)), s.missing);
  if (dry_run) return fmt::format("{}: {} would be purged\n", purged.cache, what);
  return fmt::format("{}: {} purged; the file has {} now, {} before\n", purged.cache, what,
                     bytes_text(double(s.file_bytes)), bytes_text(double(s.file_bytes_before)));
}

nlohmann::ordered_json purge_json(const Purged& purged) {
  const PurgeSummary& s = purged.summary;
  return {{"cache", purged.cache}, {"tiles", s.tiles},           {"tile_bytes", s.tile_bytes},
          {"absences", s.missing}, {"file_bytes", s.file_bytes}, {"file_bytes_before", s.file_bytes_before}};
}

std::string purge_json(const std::vector<Purged>& all, bool dry_run) {
  nlohmann::ordered_json result{{"tiles", 0}, {"absences", 0}, {"dry_run", dry_run}};
  std::int64_t tiles = 0, missing = 0;
  for (const Purged& one : all) {
    tiles += one.summary.tiles;
    missing += one.summary.missing;
    result["caches"].push_back(purge_json(one));
  }
  result["tiles"] = tiles;
  result["absences"] = missing;
  return result.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

int run_purge(const PurgeCommand& command) {
  const StopSignals signals;
  std::vector<std::string> caches = command.caches;
  if (!command.times.empty()) {
    caches.clear();
    for (const std::string& cache : command.caches) {
      auto dated = files_of_times(cache, command.times);
      if (!dated) return fail("purge", dated.error().message);
      caches.insert(caches.end(), dated->begin(), dated->end());
    }
  }
  std::vector<Purged> all;
  int code = kDone;
  for (const std::string& cache : caches) {
    const auto summary = purge_one(command, cache);
    if (!summary) {
      code = fail("purge", summary.error().message);
      continue;
    }
    all.push_back({cache, *summary});
    if (!command.json) print_result("{}", purge_text(all.back(), command.dry_run));
    if (summary->fault) {
      code = fail("purge", summary->fault->message);
      break;
    }
    if (summary->stopped) {
      print_message("terrella purge: stopped in {}; the same command {}\n", cache,
                    command.dry_run ? "counts anew" : "goes on where this one ended");
      code = kDoneInPart;
      break;
    }
  }
  if (command.json && !all.empty()) print_result("{}", purge_json(all, command.dry_run));
  return code;
}

}  // namespace

void add_purge_command(CLI::App& app, int& exit_code) {
  CLI::App& sub = *app.add_subcommand("purge", "Remove tiles from caches by area, level, time or age");
  sub.footer(kPurgeExamples);
  const auto command = std::make_shared<PurgeCommand>();
  sub.add_option("CACHE", command->caches, "Caches that preload or view filled")->required()->type_name("CACHE...");
  add_area_options(sub, command->area);
  sub.add_option("--times", command->times,
                 "Purge the caches of these times beside CACHE, as preload --times writes them; A/B: all from A to B")
      ->type_name("A/B/P1D[,...]")
      ->delimiter(',')
      ->check(time_series())
      ->allow_extra_args(false);
  sub.add_option("--older-than", command->older_than_days, "Purge only what was stored more than this many days ago")
      ->type_name("DAYS")
      ->check(number_in(0.0, 36500.0));
  sub.add_option("--unused-for", command->unused_for_days,
                 "Purge only tiles that no viewer has used for this many days; pinned ones stay")
      ->type_name("DAYS")
      ->check(number_in(0.0, 36500.0));
  sub.add_flag("--all", command->all, "Purge every tile");
  sub.add_flag("--dry-run", command->dry_run, "Count what would be purged; change nothing");
  sub.add_flag("--json", command->json, "Print the result as one JSON object");
  sub.callback([command, &exit_code] {
    if (const Status together = check_purge(*command); !together) {
      throw CLI::ValidationError("purge", together.error().message);
    }
    exit_code = run_purge(*command);
  });
}

}  // namespace terrella
