#include "apps/commands/tile_set_report.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "apps/commands/raster_facts.h"
#include "apps/process/console.h"
#include "streaming/projection_names.h"
#include "streaming/sets/tileset_json.h"

namespace terrella {
namespace {

std::string human_bytes(std::uintmax_t bytes) {
  if (bytes < 10'000) return fmt::format("{} bytes", bytes);
  if (bytes < 10'000'000) return fmt::format("{:.1f} kB", static_cast<double>(bytes) / 1e3);
  if (bytes < 10'000'000'000) return fmt::format("{:.1f} MB", static_cast<double>(bytes) / 1e6);
  return fmt::format("{:.1f} GB", static_cast<double>(bytes) / 1e9);
}

const char* format_name(ImageFormat format) {
  switch (format) {
    case ImageFormat::jpeg:
      return "JPEG";
    case ImageFormat::png:
      return "PNG";
    case ImageFormat::webp:
      return "WebP";
    case ImageFormat::unknown:
      break;
  }
  return "unknown";
}

std::string rows_text(const TileGrid& grid) {
  return fmt::format(
      "{}, {} latitude",
      grid.projection == Projection::equal_area ? "equal-area (linear in the sine of latitude)" : "equirectangular",
      grid.latitude == LatitudeKind::centric ? "planetocentric" : "planetographic");
}

std::string elevation_text(const NumberInfo& elevation) {
  const std::string nodata = elevation.nodata ? fmt::format(", {} says that there is none", *elevation.nodata) : "";
  if (!elevation.unit.empty() && elevation.unit != "m") {
    return fmt::format("numbers      {} = number * {:.9g} + {:.9g}{}{}\n", one_line(elevation.unit), elevation.scale,
                       elevation.offset, elevation.quantity.empty() ? "" : ", " + one_line(elevation.quantity), nodata);
  }
  return fmt::format("elevation    metres = number * {:.9g} + {:.9g}{}\n", elevation.scale, elevation.offset, nodata);
}

std::string made_of_text(const TileGrid& grid, const std::optional<CrsSquare>& square) {
  if (square) {
    const bool own = !square->levels.empty();
    const double pixel = own ? square->levels.back().unit_per_px
                             : tile_span_deg(grid, grid.max_level) / grid.tile_px * square->unit_per_deg;
    return fmt::format(
        "made of      tiles in {}: {} px a tile, levels {} to {}, from ({:.12g}, {:.12g}), {:.6g} units a pixel\n",
        one_line(square->crs).substr(0, 200), grid.tile_px, grid.min_level, grid.max_level, square->west, square->north,
        pixel);
  }
  return fmt::format("made of      tiles in Web Mercator (EPSG:3857): {} px a tile, levels {} to {}, {} tiles around\n",
                     grid.tile_px, grid.min_level, grid.max_level, columns(grid, grid.max_level));
}

std::string or_not_said(const std::string& text) { return text.empty() ? "(not said)" : one_line(text); }

constexpr std::array kMissingNames = {"absent", "blank", "broken", "failed"};

std::string cache_text(const CacheReport& cache) {
  std::string text = fmt::format("cache of     {}\n", one_line(redact_addresses(cache.source_key)));
  text += fmt::format("tiles        {}, {} of them expired, {} pinned\n", cache.tiles, cache.expired_tiles,
                      cache.pinned_tiles);
  for (std::size_t kind = 0; kind < kMissingNames.size(); ++kind) {
    text += fmt::format("{:<12} {}, {} of them expired\n", kMissingNames.at(kind), cache.missing.at(kind),
                        cache.expired_missing.at(kind));
  }
  if (!cache.problems) return text;
  text += fmt::format("database     {}\n", cache.problems->empty() ? "sound" : "damaged");
  for (const std::string& problem : *cache.problems) text += fmt::format("damage       {}\n", one_line(problem));
  return text;
}

nlohmann::ordered_json cache_json(const CacheReport& cache) {
  nlohmann::ordered_json object{{"source", redact_addresses(cache.source_key)},
                                {"tiles", cache.tiles},
                                {"expired_tiles", cache.expired_tiles},
                                {"pinned_tiles", cache.pinned_tiles}};
  for (std::size_t kind = 0; kind < kMissingNames.size(); ++kind) {
    object["absences"][kMissingNames.at(kind)] = {{"count", cache.missing.at(kind)},
                                                  {"expired", cache.expired_missing.at(kind)}};
  }
  if (cache.problems) object["problems"] = *cache.problems;
  return object;
}

std::string verify_text(const VerifyReport& verified) {
  std::string text = fmt::format("verified     {} tiles are good, {} absent, {} blank, {} broken\n", verified.good,
                                 verified.absent, verified.blank, verified.bad);
  for (const BadTile& tile : verified.first_bad) {
    text += fmt::format("broken       {}/{}/{}: {}\n", tile.id.level, tile.id.x, tile.id.y, one_line(tile.why));
  }
  const auto listed = static_cast<std::int64_t>(verified.first_bad.size());
  if (verified.bad > listed) text += fmt::format("             and {} more\n", verified.bad - listed);
  return text;
}

nlohmann::ordered_json verify_json(const VerifyReport& verified) {
  nlohmann::ordered_json object{
      {"good", verified.good}, {"absent", verified.absent}, {"blank", verified.blank}, {"broken", verified.bad}};
  auto& list = object["broken_tiles"] = nlohmann::ordered_json::array();
  for (const BadTile& tile : verified.first_bad) {
    list.push_back({{"level", tile.id.level}, {"x", tile.id.x}, {"y", tile.id.y}, {"why", tile.why}});
  }
  return object;
}

}  // namespace

std::string to_text(const TileSetReport& report) {
  const TileGrid& grid = report.info.grid;
  std::string text = fmt::format("tile set     {}\n", report.path.redacted());
  text += fmt::format("name         {}\n", or_not_said(report.info.name));
  text += fmt::format("attribution  {}\n", or_not_said(report.info.attribution));
  text += fmt::format("body         {}\n", or_not_said(report.info.body));
  text += fmt::format("rows         {}\n", rows_text(grid));
  text +=
      fmt::format("grid         a root tile spans {}°, {} px a tile, levels {} to {}, {:.6g}° a pixel at the finest\n",
                  grid.root_span_deg, grid.tile_px, grid.min_level, grid.max_level,
                  tile_span_deg(grid, grid.max_level) / grid.tile_px);
  text += fmt::format("bounds       west {:.9g}°, south {:.9g}°, east {:.9g}°, north {:.9g}°\n", grid.bounds.west.deg(),
                      grid.bounds.south.deg(), grid.bounds.east.deg(), grid.bounds.north.deg());
  text += fmt::format("format       {}\n", format_name(report.info.format));
  if (report.info.made_of) text += made_of_text(*report.info.made_of, report.info.square);
  if (report.info.numbers) text += elevation_text(*report.info.numbers);
  if (report.mosaic) text += mosaic_lines(*report.mosaic);
  if (!report.info.time.empty()) text += fmt::format("time         {}\n", one_line(report.info.time));
  if (!report.info.times.empty()) text += fmt::format("times        {}\n", one_line(report.info.times));
  for (const std::string& remark : report.info.remarks) text += fmt::format("remark       {}\n", one_line(remark));
  if (report.size_bytes) text += fmt::format("size         {}\n", human_bytes(*report.size_bytes));
  for (const LevelReport& level : report.levels) {
    const std::string tiles = level.tiles ? fmt::format("{} of ", *level.tiles) : "";
    text += fmt::format("level {:<6} {}{} tiles of {:.6g}°\n", level.level, tiles, level.places, level.span_deg);
  }
  if (report.cache) text += cache_text(*report.cache);
  return report.verified ? text + verify_text(*report.verified) : text;
}

std::string to_json(const TileSetReport& report) {
  auto object = nlohmann::ordered_json::parse(to_tileset_json(report.info));
  if (report.info.format == ImageFormat::unknown) object["format"] = nullptr;
  object["path"] = report.path.redacted();
  if (const auto& mosaic = report.mosaic) {
    object["files"] = {{"shown", mosaic->files}, {"left_out", mosaic->left_out}, {"groups", mosaic->sheets}};
  }
  if (!report.info.time.empty()) object["time"] = report.info.time;
  if (!report.info.times.empty()) object["times"] = report.info.times;
  if (!report.info.remarks.empty()) object["remarks"] = report.info.remarks;
  if (report.size_bytes) object["size_bytes"] = *report.size_bytes;
  if (const auto& made_of = report.info.made_of) {
    object["made_of"] = {{"projection", projection_name(made_of->projection)},
                         {"root_span_deg", made_of->root_span_deg},
                         {"tile_px", made_of->tile_px},
                         {"min_level", made_of->min_level},
                         {"max_level", made_of->max_level}};
  }
  auto& levels = object["levels"] = nlohmann::ordered_json::array();
  for (const LevelReport& level : report.levels) {
    nlohmann::ordered_json entry{{"level", level.level}, {"tile_span_deg", level.span_deg}, {"places", level.places}};
    if (level.tiles) entry["tiles"] = *level.tiles;
    levels.push_back(std::move(entry));
  }
  if (report.cache) object["cache"] = cache_json(*report.cache);
  if (report.verified) object["verified"] = verify_json(*report.verified);
  return object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace terrella
