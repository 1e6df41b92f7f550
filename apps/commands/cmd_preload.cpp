#include <fmt/core.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <utility>

#include "apps/open_scene/open_cache.h"
#include "apps/preload/missing_report.h"
#include "apps/preload/preload_archive.h"
#include "apps/preload/preload_options.h"
#include "apps/preload/preload_plan.h"
#include "apps/preload/preload_progress.h"
#include "apps/preload/preload_report.h"
#include "apps/preload/preload_room.h"
#include "apps/preload/preload_source.h"
#include "apps/preload/preload_times.h"
#include "apps/process/console.h"
#include "apps/process/open_files.h"
#include "apps/process/progress.h"
#include "apps/process/stop_signals.h"
#include "apps/process/tile_list_file.h"
#include "apps/program/commands.h"
#include "streaming/cut/output/tile_writer.h"
#include "streaming/preload/one_column.h"
#include "streaming/preload/wanted_tiles.h"

namespace terrella {
namespace {

constexpr const char* kPreloadExamples =
    "Examples:\n"
    "  terrella preload 'https://tiles.example/{z}/{x}/{y}.jpg' --levels 0-8 --bbox 5,43,17,49 --dry-run -o alps.gpkg\n"
    "  terrella preload wmts.json --polygon alps.geojson --rate 20 -o alps.gpkg\n"
    "  terrella preload https://host/mosaic.tif --bbox 5,43,17,49 -o alps.gpkg\n"
    "  terrella preload wmts.json --route pass.geojson --radius 5000 --levels 0-15 -o pass.gpkg\n"
    "  terrella preload wmts.json --flight zurich_rome.geojson --size 1920x1080 -o trip.gpkg\n"
    "  terrella preload wmts.json --times 2026-06-01/2026-06-30/P1D --bbox 5,43,17,49 -o june.gpkg\n"
    "  terrella preload 'https://web.example/{z}/{x}/{y}.png' --projection web-mercator --levels 0-9 -o web.pmtiles\n"
    "  terrella preload --task alps.json\n"
    "Preloaded tiles are pinned: a viewer's cache limit never evicts them. To unpin them:\n"
    "  terrella preload wmts.json --release -o trip.gpkg";

constexpr int kMostSampled = 20;
constexpr double kSampleRate = 10.0;      // requests per second
constexpr int kQuestionsAConnection = 8;  // in flight at once if a connection carries several requests
constexpr std::chrono::hours kDay{24};

HttpOptions network_options(const PreloadCommand& command) {
  HttpOptions http = command.http;
  http.in_flight_per_host = std::max(32, http.connections_per_host * kQuestionsAConnection);
  // With a requested rate, the first second's requests must not start all at once.
  if (http.rate_per_host > 0.0) http.burst = std::clamp(http.rate_per_host / 4.0, 1.0, http.burst);
  return http;
}

std::optional<std::chrono::seconds> refresh_age(const PreloadCommand& command) {
  if (!command.refresh_older_than_days) return std::nullopt;
  return std::chrono::duration_cast<std::chrono::seconds>(*command.refresh_older_than_days * kDay);
}

PreloadOptions preload_options(const PreloadCommand& command, const PreloadSource& source) {
  PreloadOptions options;
  options.set = source.set;
  options.refresh_older_than = refresh_age(command);
  options.tile_life = source.set.tile_life.value_or(options.tile_life);
  options.missing_life = source.set.missing_life.value_or(options.missing_life);
  options.expires = source.remote;
  if (command.between) {
    options.closed_for = [hours = *command.between] {
      return wait_for(hours, since_midnight(hours, std::chrono::system_clock::now()));
    };
  }
  return options;
}

Result<std::shared_ptr<TileCache>> cache_of(const PreloadCommand& command, const PreloadSource& source) {
  if (source.cache) return source.cache;
  auto cache = open_cache("terrella preload", cache_file_of(command.output), source.cache_info, source.key,
                          command.cache_size_mb, {});
  if (!cache) return cache.error();
  return *std::move(cache);
}

/// A cache's share of a plan.
struct Held {
  std::int64_t there = 0;    ///< fresh tiles
  std::int64_t settled = 0;  ///< WantedTiles::settled()
};

/// Counts nothing if the file does not exist.
Result<Held> count_held(const PreloadCommand& command, const PreloadSource& source, const TilePlan& plan) {
  const auto archived = has_archive(command.output, source, plan);
  if (!archived) return archived.error();
  if (*archived) return Held{.there = plan.total(), .settled = plan.total()};
  std::error_code unknown;
  if (!std::filesystem::exists(cache_file_of(command.output), unknown)) return Held{};
  const auto cache = cache_of(command, source);
  if (!cache) return cache.error();
  WantedTiles wanted(plan, **cache, refresh_age(command));
  while (!wanted.done()) {
    if (const auto next = wanted.next(); !next) return next.error();
  }
  return Held{wanted.there(), wanted.settled()};
}

SizeSample take_sample(const PreloadSource& source, const TilePlan& plan) {
  return sample_sizes(plan, kMostSampled, source.make_origin, may_wait);
}

/// Space that a plan needs. Pinned tiles of a cache that is open already are not counted: to look at its file would end
/// SQLite's locks on it.
RoomNeed need_of(const PreloadCommand& command, const PreloadSource& source, const TilePlan& plan, const Held& held) {
  if (source.cache) return {.tiles = plan.total() - held.settled};
  return room_need(command, plan, held.settled);
}

/// Checks that the plan fits into the cache, before any request except the sample's.
Status check_room(const PreloadCommand& command, const PreloadSource& source, const TilePlan& plan) {
  if (command.cache_size_mb == 0) return Done{};
  const auto held = count_held(command, source, plan);
  if (!held) return held.error();
  const RoomNeed need = need_of(command, source, plan, *held);
  if (surely_fits(command, need, source.cache_info.grid.tile_px)) return Done{};
  if (auto no_room = find_no_room(command, plan, need, take_sample(source, plan))) return *std::move(no_room);
  return Done{};
}

Result<ReleaseReport> release_tiles(const PreloadCommand& command, const PreloadSource& source, const TilePlan& plan) {
  std::error_code unknown;
  if (!std::filesystem::exists(command.output, unknown)) return Error{command.output + ": no such file"};
  const auto cache = cache_of(command, source);
  if (!cache) return cache.error();
  const auto released = pin_planned(plan, **cache, false);
  if (!released) return released.error();
  if (!command.json) {
    print_result("{}: {} tiles released; viewers with --cache-size may evict them\n", command.output, *released);
  }
  return ReleaseReport{command.output, *released};
}

int release(const PreloadCommand& command, const PreloadSource& source, const TilePlan& plan) {
  const auto report = release_tiles(command, source, plan);
  if (!report) return fail("preload", report.error().message);
  if (command.json) print_result("{}", to_json(*report));
  return kDone;
}

/// Sample of an earlier instant; takes a new one if empty.
Result<PreloadForecast> forecast(const PreloadCommand& command, const PreloadSource& source, const TilePlan& plan,
                                 const std::optional<SizeSample>& sample = {}) {
  PreloadForecast forecast{.levels = plan.counts(), .sample = {}, .no_room = {}};
  const auto held = count_held(command, source, plan);
  if (!held) return held.error();
  forecast.there = held->there;
  forecast.rate = command.http.rate_per_host;
  forecast.jobs = command.http.connections_per_host;
  if (!command.offline) {
    forecast.sample = sample ? *sample : take_sample(source, plan);
    forecast.no_room = find_no_room(command, plan, need_of(command, source, plan, *held), forecast.sample);
  }
  return forecast;
}

int print_forecast(const PreloadCommand& command, const Result<PreloadForecast>& forecast) {
  if (!forecast) return fail("preload", forecast.error().message);
  print_result("{}", command.json ? to_json(*forecast) : to_text(*forecast));
  return kDone;
}

/// True if a complete run of a URL template shows that its grid is not the server's. A template states no grid.
bool has_wrong_grid(const PreloadSource& source, const TilePlan& plan, TileCache& cache, const PreloadResult& result) {
  const TileGrid& grid = source.set.info.grid;
  const bool two_columns = grid.projection == Projection::equirectangular && grid.root_span_deg == 180.0;
  if (!source.remote || !two_columns || result.end != PreloadEnd::complete || result.counts.missing() > 0) return false;
  const auto one_column = looks_like_one_column(plan, grid, cache);
  return one_column && *one_column;
}

/// True if the server has none of the planned tiles.
bool is_empty(const PreloadCounts& c) {
  return c.planned > 0 && c.stored + c.there + c.unchanged + c.blank == 0 && c.absent == c.planned;
}

/// Reports an incomplete run to the user and returns the exit code.
int conclude(const PreloadCommand& command, const PreloadResult& result) {
  const PreloadCounts& c = result.counts;
  std::string again = "the same command goes on where this one ended";
  if (is_web_format(command.output)) {
    again += fmt::format(" and then makes {}; until then {} has the tiles, and terrella convert takes it as it is",
                         command.output, cache_file_of(command.output));
  }
  if (result.end == PreloadEnd::stopped) {
    print_message("terrella preload: stopped with {} of {} tiles to go; {}\n", c.planned - c.passed, c.planned, again);
    return kDoneInPart;
  }
  if (result.end == PreloadEnd::source_down) {
    print_message("terrella preload: given up, {} does not answer any more; {}\n", command.source.redacted(), again);
    return kDoneInPart;
  }
  if (is_empty(c)) {
    print_message("terrella preload: the server has none of the {} tiles; is {} right, and are the levels?\n",
                  c.planned, command.source.redacted());
    return kDoneInPart;
  }
  if (c.no_room > 0) {
    print_message(
        "terrella preload: {} tiles have no room under --cache-size {}; what was stored is kept; give a larger "
        "--cache-size, or fewer levels\n",
        c.no_room, command.cache_size_mb);
  }
  if (c.kept > 0) {
    print_message(
        "terrella preload: {} tiles that were stored are no longer on the server; the stored ones were kept; is "
        "the address still right?\n",
        c.kept);
  }
  if (c.missing() == 0) return c.kept == 0 ? kDone : kDoneInPart;
  print_message("terrella preload: {} tiles are missing{}; {}\n", c.missing(),
                command.missing_file.empty() ? "; --missing FILE lists them" : ", see " + command.missing_file, again);
  return kDoneInPart;
}

/// A preload that was done, wholly or in part.
struct Brought {
  PreloadReport report;
  bool has_wrong_grid = false;
};

/// Makes the archive of a whole preload, if the output is one.
Status finish_archive(const PreloadCommand& command, const PreloadSource& source, const TilePlan& plan,
                      std::shared_ptr<TileCache> cache, PreloadResult& result) {
  const bool whole = result.end == PreloadEnd::complete && result.counts.missing() == 0 && !is_empty(result.counts);
  if (!whole || !is_web_format(command.output)) return Done{};
  Progress progress("writing " + command.output);
  const auto made =
      make_archive(command.output, source, plan, std::move(cache), [&](std::int64_t done, std::int64_t total) {
        progress.show(done, total);
        return !StopSignals::came();
      });
  if (made && *made) {
    print_message("terrella preload: {} has tiles of another plan too and is kept\n", cache_file_of(command.output));
  }
  if (made) return Done{};
  if (!StopSignals::came()) return made.error();
  result.end = PreloadEnd::stopped;
  return Done{};
}

/// Answer to a preload whose archive was made before.
PreloadReport all_there(const PreloadCommand& command, const TilePlan& plan) {
  PreloadReport report;
  report.output = command.output;
  PreloadCounts& counts = report.result.counts;
  counts.planned = counts.passed = counts.there = plan.total();
  return report;
}

Result<Brought> bring(const PreloadCommand& command, const PreloadSource& source, const TilePlan& plan) {
  const auto archived = has_archive(command.output, source, plan);
  if (!archived) return archived.error();
  auto missing = MissingReport::open(command.missing_file);
  if (!missing) return missing.error();
  auto stored = TileListFile::open(command.stored_file, TileListFile::Mode::append);
  if (!stored) return stored.error();
  if (*archived) return Brought{.report = all_there(command, plan)};
  auto cache = cache_of(command, source);
  if (!cache) return cache.error();
  PreloadOptions options = preload_options(command, source);
  options.on_missing = [&](const TileId& id, PreloadMissing kind, const std::string& why) {
    missing->add(id, kind, why);
  };
  if (!command.stored_file.empty()) options.on_stored = [&](const TileId& id) { stored->add(id); };
  const auto begun = std::chrono::steady_clock::now();
  Result<PreloadResult> result = Error{};
  {
    PreloadProgress progress(command.between ? command.between->text : "");
    options.progress = [&](const PreloadCounts& counts) {
      progress.show(counts);
      return !StopSignals::came();
    };
    result = preload(plan, **cache, source.make_origin, options);
  }
  if (!result) return Error{result.error().message + "; the same command goes on"};
  for (const Status& listed : {missing->close(), stored->close()}) {
    if (!listed) return listed.error();
  }
  const bool wrong_grid = has_wrong_grid(source, plan, **cache, *result);
  if (Status made = finish_archive(command, source, plan, *std::move(cache), *result); !made) return made.error();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  return Brought{.report = {command.output, {}, *result, missing->groups(), seconds}, .has_wrong_grid = wrong_grid};
}

/// Reports what is wrong with a run to the user and returns the exit code.
int judge(const PreloadCommand& command, const Brought& brought) {
  if (brought.has_wrong_grid) {
    print_message(
        "terrella preload: {}: the server has no tile in the eastern half of the planet, and all in the western; most "
        "likely its level 0 has one column, as Web Mercator has: preload into another file with --projection "
        "web-mercator (or --root-span 360)\n",
        command.source.redacted());
    return kDoneInPart;
  }
  return conclude(command, brought.report.result);
}

int bring_and_tell(const PreloadCommand& command, const PreloadSource& source, const TilePlan& plan) {
  const auto brought = bring(command, source, plan);
  if (!brought) return fail("preload", brought.error().message);
  print_result("{}", command.json ? to_json(brought->report) : to_text(brought->report));
  return judge(command, *brought);
}

/// A preload of several instants, one after the other.
class ManyTimes {
 public:
  ManyTimes(const PreloadCommand& command, const PreloadSource& source, const HttpOptions& http, const TilePlan& plan)
      : command_(command), source_(source), http_(http), plan_(plan) {}

  int run(const std::vector<UtcTime>& instants, std::optional<WaitLimit>& limit) {
    if (command_.dry_run) return print_forecast(command_, forecast_all(instants));
    if (command_.release) return release_all(instants);
    int code = kDone;
    for (const UtcTime instant : instants) {
      const auto source = source_at(source_, instant, http_);
      const int one = source ? load(command_at(command_, source->set.info.time), *source, limit)
                             : fail("preload", source.error().message);
      if (one != kDone) code = one;
      if (one == kFailed || ends_) break;
    }
    // A failure leaves the reports of the instants before it.
    if (command_.json && !reports_.empty()) print_result("{}", to_json(reports_));
    return code;
  }

 private:
  Result<PreloadForecast> forecast_all(const std::vector<UtcTime>& instants) {
    PreloadForecast all{.levels = {}, .sample = {}, .no_room = {}};
    std::optional<SizeSample> sample;
    for (const UtcTime instant : instants) {
      const auto source = source_at(source_, instant, http_);
      if (!source) return source.error();
      const auto one = forecast(command_at(command_, source->set.info.time), *source, plan_, sample);
      if (!one) return one.error();
      if (!sample) {
        all.sample = one->sample;
        all.rate = one->rate;
        all.jobs = one->jobs;
        sample = one->sample;
      }
      add(all, *one);
    }
    return all;
  }

  /// Passes over instants without a file, unless none has one.
  int release_all(const std::vector<UtcTime>& instants) {
    std::vector<ReleaseReport> reports;
    std::string absent;
    int code = kDone;
    for (const UtcTime instant : instants) {
      const auto source = source_at(source_, instant, http_);
      if (!source) return fail("preload", source.error().message);
      const PreloadCommand command = command_at(command_, source->set.info.time);
      std::error_code unknown;
      if (!std::filesystem::exists(command.output, unknown)) {
        if (absent.empty()) absent = command.output;
        continue;
      }
      auto report = release_tiles(command, *source, plan_);
      if (!report) {
        code = fail("preload", report.error().message);
        break;
      }
      reports.push_back(*std::move(report));
    }
    if (reports.empty() && code == kDone) return fail("preload", absent + ": no such file");
    if (command_.json && !reports.empty()) print_result("{}", to_json(reports));
    return code;
  }

  int load(const PreloadCommand& command, const PreloadSource& source, std::optional<WaitLimit>& limit) {
    if (const Status room = check_room(command, source, plan_); !room) return fail("preload", room.error().message);
    limit.reset();
    auto brought = bring(command, source, plan_);
    if (!brought) return fail("preload", brought.error().message);
    brought->report.time = source.set.info.time;
    if (command.json) {
      reports_.push_back(brought->report);
    } else {
      print_result("{}", to_text(brought->report));
    }
    ends_ = brought->report.result.end != PreloadEnd::complete;
    return judge(command, *brought);
  }

  const PreloadCommand& command_;
  const PreloadSource& source_;
  const HttpOptions& http_;
  const TilePlan& plan_;
  std::vector<PreloadReport> reports_;
  bool ends_ = false;  ///< stopped, or the source is down
};

Result<std::vector<UtcTime>> instants_of(const PreloadCommand& command, const PreloadSource& source) {
  if (command.times.empty()) return std::vector<UtcTime>();
  const auto& steps = source.set.info.steps;
  if (!steps) return Error{command.source.redacted() + ": has no list of times; omit --times"};
  return preload_instants(command.times, *steps);
}

/// Reduces --jobs to the allowed open files; a connection that fails to open would look like a failing server.
void fit_jobs(PreloadCommand& command) {
  const int asked = command.http.connections_per_host;
  int& jobs = command.http.connections_per_host;
  jobs = connections_that_fit(asked);
  if (jobs == asked) return;
  print_message(
      "terrella preload: --jobs {} needs more open files than this process may have, so it is --jobs {}; "
      "`ulimit -n {}` before it allows all\n",
      asked, jobs, asked + 64);
}

int run(PreloadCommand& command) {
  fit_jobs(command);
  if (command.area.levels && !command.remote.max_level) command.remote.max_level = command.area.levels->last;
  const StopSignals signals;
  std::optional<WaitLimit> limit(command.timeout_s);
  HttpOptions http = network_options(command);
  if (command.dry_run) {
    const double rate = http.rate_per_host;
    http.rate_per_host = rate > 0.0 ? std::min(rate, kSampleRate) : kSampleRate;
    http.attempts = 1;
  }
  PreloadTiff tiff{.cache = {}, .cache_size_mb = command.cache_size_mb};
  std::error_code unknown;
  // A dry run makes no file.
  const bool has_cache = !is_web_format(command.output);
  if (has_cache && (!command.dry_run || std::filesystem::exists(command.output, unknown))) tiff.cache = command.output;
  const auto source = open_preload_source(command.source, command.remote, http, tiff);
  if (!source) return fail("preload", source.error().message + WaitLimit::advice());
  if (!source->set.refuse_bulk.empty())
    return fail("preload", command.source.redacted() + ": " + source->set.refuse_bulk);
  if (Status fits = check_archive(command.output, *source); !fits) return fail("preload", fits.error().message);
  const auto instants = instants_of(command, *source);
  if (!instants) return fail("preload", instants.error().message);
  auto plan = make_preload_plan(command, source->set.info);
  if (plan && source->plan_parts) plan = source->plan_parts(**plan);
  if (!plan) return fail("preload", plan.error().message + WaitLimit::advice());
  if (!instants->empty()) return ManyTimes(command, *source, http, **plan).run(*instants, limit);
  if (command.release) return release(command, *source, **plan);
  if (command.dry_run) return print_forecast(command, forecast(command, *source, **plan));
  if (const Status room = check_room(command, *source, **plan); !room) return fail("preload", room.error().message);
  limit.reset();
  return bring_and_tell(command, *source, **plan);
}

}  // namespace

void add_preload_command(CLI::App& app, int& exit_code) {
  CLI::App& sub = *app.add_subcommand("preload", "Fill a cache before going offline");
  sub.footer(kPreloadExamples);
  const auto command = std::make_shared<PreloadCommand>();
  add_preload_options(sub, *command);
  sub.callback([command, &exit_code] {
    if (const Status together = check_together(*command); !together) {
      throw CLI::ValidationError("preload", together.error().message);
    }
    exit_code = run(*command);
  });
}

}  // namespace terrella
