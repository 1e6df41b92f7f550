#include "streaming/preload/geojson_text.h"

#include <fmt/format.h>

#include <cmath>

#include "base/number.h"
#include "streaming/file_bytes.h"
#include "streaming/json_text.h"
#include "streaming/preload/geojson_region.h"

namespace terrella {

using nlohmann::json;

namespace {

using TakeGeometry = std::function<Status(const json&)>;

Status take_parts(const json& geometry, const TakeGeometry& take) {
  return geojson_type(geometry) == "GeometryCollection" ? for_each_entry(geometry, "geometries", take) : take(geometry);
}

Status take_feature(const json& feature, const TakeGeometry& take) {
  if (geojson_type(feature) != "Feature") return Error{"not a Feature"};
  const auto geometry = feature.find("geometry");
  if (geometry == feature.end()) return Error{"a Feature without \"geometry\""};
  return geometry->is_null() ? Status(Done{}) : take_parts(*geometry, take);
}

Status take_features(const json& object, const TakeGeometry& take) {
  const auto features = object.find("features");
  if (features == object.end() || !features->is_array()) return Error{"a FeatureCollection without \"features\""};
  for (std::size_t i = 0; i < features->size(); ++i) {
    const json& feature = (*features)[i];
    if (const Status taken = take_feature(feature, take); !taken) {
      return Error{fmt::format("{}: {}", feature_name(feature, i), taken.error().message)};
    }
  }
  return Done{};
}

}  // namespace

Status for_each_geometry(const json& document, const TakeGeometry& take) {
  const std::string type = geojson_type(document);
  if (type == "FeatureCollection") return take_features(document, take);
  return type == "Feature" ? take_feature(document, take) : take_parts(document, take);
}

Status for_each_entry(const json& object, const char* list, const TakeGeometry& take) {
  const auto entries = object.find(list);
  if (entries == object.end() || !entries->is_array()) return Error{fmt::format("it has no list \"{}\"", list)};
  for (const json& entry : *entries) {
    if (const Status taken = take(entry); !taken) return taken.error();
  }
  return Done{};
}

Result<json> parse_geojson(std::string_view text, const std::string& where) {
  Result<json> object = parse_json(text);
  if (!object) return Error{fmt::format("{}: {}; a GeoJSON file (RFC 7946) is needed", where, object.error().message)};
  if (geojson_type(*object).empty()) {
    return Error{fmt::format("{}: JSON, but no GeoJSON: it has no \"type\"; see RFC 7946", where)};
  }
  return object;
}

Result<std::string> read_geojson_text(const std::filesystem::path& path) {
  const auto bytes = read_file(path, kMaxGeojsonBytes);
  if (!bytes) return Error{bytes.error().message};
  return std::string(as_text(*bytes));
}

std::string geojson_type(const json& object) {
  if (!object.is_object()) return {};
  const auto type = object.find("type");
  return type != object.end() && type->is_string() ? type->get<std::string>() : std::string();
}

std::string feature_name(const json& feature, std::size_t index) {
  std::string number = fmt::format("feature {}", index + 1);
  const auto named = [&number](const json& object, const char* member) {
    if (!object.is_object()) return std::string();
    const auto name = object.find(member);
    const bool is_text = name != object.end() && name->is_string();
    return is_text ? fmt::format("{} ({})", number, in_quotes(name->get<std::string>())) : std::string();
  };
  if (!feature.is_object()) return number;
  const auto properties = feature.find("properties");
  std::string name = properties == feature.end() ? std::string() : named(*properties, "name");
  if (name.empty()) name = named(feature, "id");
  return name.empty() ? number : name;
}

Result<MapPoint> geojson_position(const json& position) {
  if (!position.is_array() || position.size() < 2 || !position[0].is_number() || !position[1].is_number()) {
    return Error{"a position is not [longitude, latitude]"};
  }
  const MapPoint p{position[0].get<double>(), position[1].get<double>()};
  constexpr double kMostLongitude = 540.0;  // one and a half turns, because rings continued over ±180° are common
  if (!(std::abs(p.lon_deg) <= kMostLongitude) || !(std::abs(p.lat_deg) <= 90.0)) {
    return Error{fmt::format("the position {},{} is not on the planet; GeoJSON is degrees, longitude first", p.lon_deg,
                             p.lat_deg)};
  }
  return p;
}

}  // namespace terrella
