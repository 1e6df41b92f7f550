#include "streaming/tileset_json.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "geo/body.h"
#include "streaming/tileset_check.h"

namespace terrella {
namespace {

using nlohmann::json;

constexpr int kVersion = 1;
constexpr std::size_t kMaxTextBytes = 16384;

// An angle that was given as 45 comes back from radians as 45.000000000000007; 1e-11 degrees is a micrometre on Earth.
double tidy_degrees(Angle angle) { return std::round(angle.deg() * 1e11) / 1e11; }

const char* name_of(ImageFormat format) { return format == ImageFormat::png ? "png" : "jpg"; }

/// Reads the fields of one object; the first one that is wrong is kept as the error.
class Fields {
 public:
  Fields(const json& object, const std::string& where) : object_(object), where_(where) {}

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

  std::string text(const char* field) {
    const json* value = find(field, false);
    if (value == nullptr) return {};
    if (!value->is_string()) return fail<std::string>(field, "must be a text");
    const auto& text = value->get_ref<const std::string&>();
    if (text.size() > kMaxTextBytes)
      return fail<std::string>(field, fmt::format("is longer than {} bytes", kMaxTextBytes));
    return text;
  }

  int integer(const char* field, std::optional<int> otherwise) {
    const json* value = find(field, !otherwise);
    if (value == nullptr) return otherwise.value_or(0);
    const bool small = value->is_number_integer() && std::abs(value->get<double>()) < 1e9;
    return small ? value->get<int>() : fail<int>(field, "must be a whole number");
  }

  double number(const char* field) {
    const json* value = find(field, true);
    if (value == nullptr) return 0.0;
    return value->is_number() ? value->get<double>() : fail<double>(field, "must be a number");
  }

  /// One of two words, as 0 or 1.
  int choice(const char* field, const char* first, const char* second, std::optional<int> otherwise) {
    const json* value = find(field, !otherwise);
    if (value == nullptr) return otherwise.value_or(0);
    if (*value == first) return 0;
    if (*value == second) return 1;
    return fail<int>(field, fmt::format("must be \"{}\" or \"{}\"", first, second));
  }

  GeoRect bounds(const char* field) {
    const json* value = find(field, false);
    if (value == nullptr) return {};
    if (!value->is_array() || value->size() != 4) return fail<GeoRect>(field, "must be [west, south, east, north]");
    for (const json& side : *value) {
      if (!side.is_number()) return fail<GeoRect>(field, "must hold four numbers, in degrees");
    }
    const auto side = [&](std::size_t i) { return Angle::degrees((*value)[i].get<double>()); };
    return {.west = side(0), .south = side(1), .east = side(2), .north = side(3)};
  }

  template <class T>
  T fail(const char* field, const std::string& what) {
    if (!error_) error_ = Error{fmt::format("{}: the field \"{}\" {}", where_, field, what)};
    return T{};
  }

 private:
  const json* find(const char* field, bool required) {
    const auto found = object_.find(field);
    if (found != object_.end() && !found->is_null()) return &*found;
    if (required) fail<int>(field, "is missing");
    return nullptr;
  }

  const json& object_;
  const std::string& where_;
  std::optional<Error> error_;
};

Result<TileSetInfo> read_fields(const json& object, const std::string& where) {
  Fields fields(object, where);
  TileSetInfo info;
  const int version = fields.integer("version", kVersion);
  if (version < 1 || version > kVersion) {
    fields.fail<int>("version", fmt::format("is {}, this program reads version {}", version, kVersion));
  }
  info.name = fields.text("name");
  info.attribution = fields.text("attribution");
  info.body = fields.text("body");
  info.grid.root_span_deg = fields.number("root_span_deg");
  info.grid.tile_px = fields.integer("tile_px", std::nullopt);
  info.grid.min_level = fields.integer("min_level", 0);
  info.grid.max_level = fields.integer("max_level", std::nullopt);
  info.grid.projection = fields.choice("projection", "equirectangular", "equal-area", 0) == 1
                             ? Projection::equal_area
                             : Projection::equirectangular;
  info.grid.latitude =
      fields.choice("latitude", "graphic", "centric", 0) == 1 ? LatitudeKind::centric : LatitudeKind::graphic;
  info.grid.bounds = fields.bounds("bounds");
  info.format = fields.choice("format", "jpg", "png", std::nullopt) == 1 ? ImageFormat::png : ImageFormat::jpeg;
  if (fields.error()) return *fields.error();
  if (Status grid = check_grid(info.grid, where); !grid) return grid.error();
  if (!info.body.empty()) {
    if (const auto body = parse_body(info.body); !body)
      return Error{where + ": the field \"body\": " + body.error().message};
  }
  return info;
}

}  // namespace

std::string to_tileset_json(const TileSetInfo& info) {
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
  object["projection"] = grid.projection == Projection::equal_area ? "equal-area" : "equirectangular";
  object["latitude"] = grid.latitude == LatitudeKind::centric ? "centric" : "graphic";
  object["bounds"] = {tidy_degrees(grid.bounds.west), tidy_degrees(grid.bounds.south), tidy_degrees(grid.bounds.east),
                      tidy_degrees(grid.bounds.north)};
  object["format"] = name_of(info.format);
  return object.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Result<TileSetInfo> parse_tileset_json(std::string_view text, const std::string& where) {
  if (text.size() > kMaxTileSetJsonBytes) {
    return Error{fmt::format("{}: {} bytes are too many for a description of a tile set, at most {} are read", where,
                             text.size(), kMaxTileSetJsonBytes)};
  }
  json object;
  try {
    object = json::parse(text);
  } catch (const json::exception& error) {
    return Error{fmt::format("{}: not JSON: {}", where, error.what())};
  }
  if (!object.is_object()) return Error{where + ": must hold one JSON object"};
  return read_fields(object, where);
}

}  // namespace terrella
