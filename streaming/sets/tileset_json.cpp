#include "streaming/sets/tileset_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "geo/body.h"
#include "streaming/georeference/crs_text.h"
#include "streaming/json_fields.h"
#include "streaming/projection_names.h"
#include "streaming/sets/elevation_json.h"
#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

using nlohmann::json;

constexpr int kVersion = 1;
/// Format of tiles of floats.
constexpr const char* kTiffEnding = "tif";

/// Reads a level with a place of its own: west, north, unit_per_px, columns, rows.
std::optional<CrsLevel> read_crs_level(const json& value) {
  const auto is_number = [](const json& part) { return part.is_number(); };
  if (!value.is_array() || value.size() != 5 || !std::ranges::all_of(value, is_number)) return std::nullopt;
  constexpr double kFarthest = 1e12;
  const double west = value[0], north = value[1], pixel = value[2], columns = value[3], rows = value[4];
  const bool good = std::abs(west) < kFarthest && std::abs(north) < kFarthest && pixel > 0.0 && pixel < kFarthest &&
                    columns >= 1.0 && columns <= kMaxTilesASide && rows >= 1.0 && rows <= kMaxTilesASide;
  if (!good) return std::nullopt;
  return CrsLevel{.west = west,
                  .north = north,
                  .unit_per_px = pixel,
                  .columns = static_cast<std::int64_t>(columns),
                  .rows = static_cast<std::int64_t>(rows)};
}

Result<std::vector<CrsLevel>> read_crs_levels(const json& square) {
  std::vector<CrsLevel> levels;
  const auto list = square.find("levels");
  if (list == square.end()) return levels;
  const Error fault{"has \"levels\" that are no list of [west, north, unit_per_px, columns, rows]"};
  if (!list->is_array() || list->size() > kMaxTileLevel + 1) return fault;
  levels.reserve(list->size());
  for (const json& value : *list) {
    const auto level = read_crs_level(value);
    if (!level) return fault;
    levels.push_back(*level);
  }
  return levels;
}

/// Reads the square of a `projected` grid.
std::optional<CrsSquare> read_square(const json& object, JsonFields& fields, const std::string& where) {
  if (!fields.has("square")) return {};
  const json& value = object["square"];
  if (!value.is_object()) return fields.fail<std::optional<CrsSquare>>("square", "must be an object");
  JsonFields inner(value, where);
  CrsSquare square{.crs = inner.text("crs"),
                   .west = inner.number("west"),
                   .north = inner.number("north"),
                   .unit_per_deg = inner.number("unit_per_deg")};
  if (inner.error() || square.crs.empty() || !(square.unit_per_deg > 0.0)) {
    return fields.fail<std::optional<CrsSquare>>("square",
                                                 "takes the text crs and the numbers west, north, unit_per_deg");
  }
  const Result<std::string> harmless = stated_crs(square.crs);
  if (!harmless) return fields.fail<std::optional<CrsSquare>>("square", harmless.error().message);
  auto levels = read_crs_levels(value);
  if (!levels) return fields.fail<std::optional<CrsSquare>>("square", levels.error().message);
  square.levels = *std::move(levels);
  return square;
}

Result<TileSetInfo> read_fields(const json& object, const std::string& where) {
  JsonFields fields(object, where);
  TileSetInfo info;
  const int version = fields.integer("version", kVersion);
  if (version < 1 || version > kVersion) {
    fields.fail<int>("version", fmt::format("is {}, this program reads version {}", version, kVersion));
  }
  info.name = fields.text("name");
  info.attribution = fields.text("attribution");
  info.body = fields.text("body");
  const bool mercator = fields.choice("projection", kProjectionNames, 0) == static_cast<int>(Projection::web_mercator);
  info.grid.root_span_deg = mercator && !fields.has("root_span_deg") ? 360.0 : fields.number("root_span_deg");
  info.grid.tile_px = fields.integer("tile_px", std::nullopt);
  info.grid.min_level = fields.integer("min_level", 0);
  info.grid.max_level = fields.integer("max_level", std::nullopt);
  info.grid.projection = static_cast<Projection>(fields.choice("projection", kProjectionNames, 0));
  info.grid.latitude =
      fields.choice("latitude", "graphic", "centric", 0) == 1 ? LatitudeKind::centric : LatitudeKind::graphic;
  info.grid.bounds = fields.bounds("bounds");
  if (fields.has("origin_west_deg")) info.grid.west_deg = fields.number("origin_west_deg");
  if (fields.has("origin_north_deg")) info.grid.north_deg = fields.number("origin_north_deg");
  info.grid.reduced = fields.choice("polar_rows", "full", "squeezed too", 0) == 1;
  info.numbers = read_elevation(object, fields, where);
  const bool tiff = info.numbers && info.numbers->floats && fields.has("format") && object["format"] == kTiffEnding;
  info.format =
      tiff ? ImageFormat::png : static_cast<ImageFormat>(fields.choice("format", kImageFormatNames, std::nullopt));
  if (info.numbers && !info.numbers->rgb && info.format != ImageFormat::png) {
    fields.fail<int>("format", "must be \"png\" where there is an \"elevation\"");
  }
  info.square = read_square(object, fields, where);
  if (info.square.has_value() != (info.grid.projection == Projection::projected)) {
    fields.fail<int>("square", "and the projection \"projected\" need each other");
  }
  if (info.square && !info.square->levels.empty() &&
      std::cmp_less_equal(info.square->levels.size(), info.grid.max_level)) {
    fields.fail<int>("square", "has fewer \"levels\" than the grid");
  }
  if (fields.error()) return *fields.error();
  if (Status grid = check_grid(info.grid, where); !grid) return grid.error();
  if (!info.body.empty()) {
    if (const auto body = parse_body(info.body); !body)
      return Error{where + ": the field \"body\": " + body.error().message};
  }
  return info;
}

}  // namespace

double tidy_degrees(Angle angle) { return std::round(angle.deg() * 1e11) / 1e11; }

std::string to_tileset_json(const TileSetInfo& info, const std::string& cut_key) {
  const TileGrid& grid = info.grid;
  nlohmann::ordered_json object;
  object["version"] = kVersion;
  object["name"] = info.name;
  object["attribution"] = info.attribution;
  object["body"] = info.body;
  object["root_span_deg"] = grid.root_span_deg;
  object["tile_px"] = grid.tile_px;
  object["min_level"] = grid.min_level;
  object["max_level"] = grid.max_level;
  object["projection"] = projection_name(grid.projection);
  object["latitude"] = grid.latitude == LatitudeKind::centric ? "centric" : "graphic";
  object["bounds"] = {tidy_degrees(grid.bounds.west), tidy_degrees(grid.bounds.south), tidy_degrees(grid.bounds.east),
                      tidy_degrees(grid.bounds.north)};
  if (!begins_at_planet(grid)) {
    object["origin_west_deg"] = grid.west_deg;
    object["origin_north_deg"] = grid.north_deg;
  }
  if (grid.reduced) object["polar_rows"] = "squeezed too";
  object["format"] = tile_ending(info);
  if (info.numbers) {
    object["elevation"] = {{"scale", info.numbers->scale}, {"offset", info.numbers->offset}};
    auto& elevation = object["elevation"];
    if (info.numbers->nodata && info.numbers->floats) elevation["nodata"] = *info.numbers->nodata;
    if (info.numbers->nodata && !info.numbers->floats) elevation["nodata"] = static_cast<int>(*info.numbers->nodata);
    if (info.numbers->is_signed) elevation["numbers"] = "signed";
    if (info.numbers->floats) elevation["numbers"] = "float";
    if (info.numbers->rgb) elevation["numbers"] = "rgb";
    if (!info.numbers->unit.empty()) elevation["unit"] = info.numbers->unit;
    if (!info.numbers->quantity.empty()) elevation["quantity"] = info.numbers->quantity;
  }
  if (const auto& square = info.square) {
    object["square"] = {
        {"crs", square->crs}, {"west", square->west}, {"north", square->north}, {"unit_per_deg", square->unit_per_deg}};
    for (const CrsLevel& level : square->levels) {
      object["square"]["levels"].push_back({level.west, level.north, level.unit_per_px, level.columns, level.rows});
    }
  }
  if (!cut_key.empty()) object[kCutKeyField] = cut_key;
  return object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string stated_body(std::string text) { return parse_body(text) ? text : std::string(); }

const char* tile_ending(const TileSetInfo& info) {
  return info.numbers && info.numbers->floats ? kTiffEnding : extension_of(info.format);
}

std::optional<std::string> read_cut_key(std::string_view text) {
  const Result<json> object = parse_json_object(text, kMaxTileSetJsonBytes, {});
  if (!object) return {};
  const auto key = object->find(kCutKeyField);
  return key != object->end() && key->is_string() ? std::optional(key->get<std::string>()) : std::nullopt;
}

Result<TileSetInfo> parse_tileset_json(std::string_view text, const std::string& where) {
  const Result<json> object = parse_json_object(text, kMaxTileSetJsonBytes, where);
  if (!object) return object.error();
  return read_fields(*object, where);
}

}  // namespace terrella
