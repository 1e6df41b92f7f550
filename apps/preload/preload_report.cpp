#include "apps/preload/preload_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/preload/preload_progress.h"

namespace terrella {
namespace {

using nlohmann::json;

constexpr std::size_t kMostReasonsTold = 20;

const char* end_name(PreloadEnd end) {
  switch (end) {
    case PreloadEnd::complete:
      return "complete";
    case PreloadEnd::stopped:
      return "stopped";
    case PreloadEnd::source_down:
      break;
  }
  return "source down";
}

std::string tile_name(const TileId& id) { return fmt::format("{}/{}/{}", id.level, id.x, id.y); }

/// Texts from servers may contain bytes that are not UTF-8.
std::string text_of(const json& object) { return object.dump(2, ' ', false, json::error_handler_t::replace) + "\n"; }

std::int64_t tiles_in(const PreloadForecast& forecast) {
  std::int64_t tiles = 0;
  for (const LevelCount& level : forecast.levels) tiles += level.tiles;
  return tiles;
}

std::optional<double> bytes_of(const PreloadForecast& forecast) {
  if (forecast.sample.answered == 0) return std::nullopt;
  return forecast.sample.bytes_per_tile * static_cast<double>(tiles_in(forecast) - forecast.there);
}

std::optional<double> seconds_of(const PreloadForecast& forecast) {
  const auto tiles = static_cast<double>(tiles_in(forecast) - forecast.there);
  const double at_rate = forecast.rate > 0.0 ? tiles / forecast.rate : 0.0;
  if (forecast.sample.answered > 0) {
    return std::max(at_rate, tiles * forecast.sample.seconds_per_tile / forecast.jobs);
  }
  return forecast.rate > 0.0 ? std::optional(at_rate) : std::nullopt;
}

}  // namespace

std::string to_text(const PreloadReport& report) {
  const PreloadCounts& c = report.result.counts;
  std::string text = fmt::format(
      "{}: of {} tiles {} stored ({}), {} there already, {} unchanged, {} not on the server, {} blank, {} missing\n"
      "{} requests, {} of them retries, in {}\n",
      report.output, c.planned, c.stored, bytes_text(static_cast<double>(c.stored_bytes)), c.there, c.unchanged,
      c.absent, c.blank, c.missing(), c.asked.requests, c.asked.retries, duration_text(report.seconds));
  if (c.kept > 0) {
    text += fmt::format("{} tiles that were stored are no longer on the server; the stored ones were kept\n", c.kept);
  }
  for (std::size_t i = 0; i < std::min(report.missing.size(), kMostReasonsTold); ++i) {
    const MissingReport::Group& group = report.missing[i];
    text += fmt::format("  {} {}: {} (the first is {})\n", group.tiles, missing_name(group.kind), group.why,
                        tile_name(group.first));
  }
  if (report.missing.size() > kMostReasonsTold) {
    text += fmt::format("  and {} more reasons; --missing FILE writes all\n", report.missing.size() - kMostReasonsTold);
  }
  return text;
}

namespace {

json object_of(const PreloadReport& report) {
  const PreloadCounts& c = report.result.counts;
  json missing = json::array();
  for (const MissingReport::Group& group : report.missing) {
    missing.push_back({{"kind", missing_name(group.kind)},
                       {"why", group.why},
                       {"tiles", group.tiles},
                       {"first", tile_name(group.first)}});
  }
  json object = {{"output", report.output},
                 {"end", end_name(report.result.end)},
                 {"planned", c.planned},
                 {"stored", c.stored},
                 {"stored_bytes", c.stored_bytes},
                 {"there", c.there},
                 {"unchanged", c.unchanged},
                 {"absent", c.absent},
                 {"blank", c.blank},
                 {"broken", c.broken},
                 {"refused", c.refused},
                 {"failed", c.failed},
                 {"no_room", c.no_room},
                 {"kept", c.kept},
                 {"not_reached", c.planned - c.passed},
                 {"requests", c.asked.requests},
                 {"retries", c.asked.retries},
                 {"seconds", report.seconds},
                 {"lacking", missing}};
  if (!report.time.empty()) object["time"] = report.time;
  return object;
}

}  // namespace

std::string to_json(const PreloadReport& report) { return text_of(object_of(report)); }

std::string to_json(const std::vector<PreloadReport>& instants) {
  json all = {{"instants", json::array()}, {"planned", 0}, {"stored", 0}, {"there", 0}, {"requests", 0}};
  for (const PreloadReport& report : instants) {
    const json one = object_of(report);
    for (const char* count : {"planned", "stored", "there", "requests"}) {
      all[count] = all[count].get<std::int64_t>() + one[count].get<std::int64_t>();
    }
    all["instants"].push_back(one);
  }
  return text_of(all);
}

std::string to_json(const ReleaseReport& report) {
  return text_of({{"output", report.output}, {"released", report.released}});
}

std::string to_json(const std::vector<ReleaseReport>& instants) {
  json all = json::array();
  std::int64_t released = 0;
  for (const ReleaseReport& report : instants) {
    all.push_back({{"output", report.output}, {"released", report.released}});
    released += report.released;
  }
  return text_of({{"instants", all}, {"released", released}});
}

std::string to_text(const PreloadForecast& forecast) {
  std::string text;
  for (const LevelCount& level : forecast.levels) {
    text += fmt::format("level {:2}: {} tiles\n", level.level, level.tiles);
  }
  if (forecast.instants > 0) text += fmt::format("{} times; the counts are for all of them\n", forecast.instants);
  text += fmt::format("in all: {} tiles, {} of them there already\n", tiles_in(forecast), forecast.there);
  const auto bytes = bytes_of(forecast);
  const auto seconds = seconds_of(forecast);
  text += bytes ? fmt::format("about {}, by a sample of {} tiles\n", bytes_text(*bytes), forecast.sample.answered)
                : fmt::format("bytes: unknown{}\n", forecast.sample.why.empty() ? "" : ": " + forecast.sample.why);
  text += seconds ? fmt::format("about {}{}\n", duration_text(*seconds),
                                forecast.rate > 0.0 ? fmt::format(" at {} requests a second", forecast.rate) : "")
                  : "time: unknown\n";
  if (forecast.no_room) text += "would be refused: " + forecast.no_room->message + "\n";
  return text;
}

std::string to_json(const PreloadForecast& forecast) {
  json levels = json::array();
  for (const LevelCount& level : forecast.levels) levels.push_back({{"level", level.level}, {"tiles", level.tiles}});
  json object = {{"tiles", tiles_in(forecast)},
                 {"there", forecast.there},
                 {"levels", levels},
                 {"sampled", forecast.sample.answered},
                 {"bytes", nullptr},
                 {"seconds", nullptr},
                 {"fits", !forecast.no_room}};
  if (forecast.instants > 0) object["instants"] = forecast.instants;
  if (const auto bytes = bytes_of(forecast)) object["bytes"] = *bytes;
  if (const auto seconds = seconds_of(forecast)) object["seconds"] = *seconds;
  return text_of(object);
}

}  // namespace terrella
