#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/preload/flight_tiles.h"
#include "streaming/preload/geojson_text.h"

namespace terrella {
namespace {

using nlohmann::json;

constexpr double kHighest_m = 1e12;

Status read_angle(const json& properties, const char* name, double low, double high, Angle& angle) {
  const auto value = properties.find(name);
  if (value == properties.end() || value->is_null()) return Done{};
  if (!value->is_number() || !(value->get<double>() >= low) || !(value->get<double>() <= high)) {
    return Error{fmt::format("its property {} is not a number in {}...{}, degrees", name, low, high)};
  }
  angle = Angle::degrees(value->get<double>());
  return Done{};
}

/// View direction of a Feature.
Result<Camera> camera_of(const json& object) {
  Camera camera;
  const auto properties = object.find("properties");
  if (properties == object.end() || !properties->is_object()) return camera;
  if (Status read = read_angle(*properties, "pitch", -90.0, 90.0, camera.pitch); !read) return read.error();
  if (Status read = read_angle(*properties, "heading", -360.0, 360.0, camera.heading); !read) return read.error();
  if (Status read = read_angle(*properties, "fov", 0.01, 170.0, camera.fov_y); !read) return read.error();
  return camera;
}

Result<std::vector<Camera>> read_way(const json& line, const Camera& looks) {
  if (geojson_type(line) != "LineString") return Error{"its geometry is not a LineString"};
  const auto positions = line.find("coordinates");
  if (positions == line.end() || !positions->is_array() || positions->empty()) {
    return Error{"a LineString without positions"};
  }
  std::vector<Camera> way;
  for (const json& position : *positions) {
    const auto place = geojson_position(position);
    if (!place) return place.error();
    if (position.size() < 3 || !position[2].is_number()) {
      return Error{fmt::format("the position {},{} has no height; the third coordinate is the eye's, metres",
                               place->lon_deg, place->lat_deg)};
    }
    Camera camera = looks;
    camera.eye = {Angle::degrees(place->lat_deg), Angle::degrees(place->lon_deg), position[2].get<double>()};
    if (!(camera.eye.height_m > 0.0) || !(camera.eye.height_m <= kHighest_m)) {
      return Error{fmt::format("the height {} is not in 0...{} m", camera.eye.height_m, kHighest_m)};
    }
    way.push_back(camera);
  }
  return way;
}

Result<std::vector<Camera>> read_feature(const json& feature) {
  const auto looks = camera_of(feature);
  if (!looks) return looks.error();
  const auto geometry = feature.find("geometry");
  if (geometry == feature.end()) return Error{"a Feature without \"geometry\""};
  return read_way(*geometry, *looks);
}

Result<std::vector<std::vector<Camera>>> read_ways(const json& object) {
  const std::string type = geojson_type(object);
  if (type != "FeatureCollection") {
    auto way = type == "Feature" ? read_feature(object) : read_way(object, Camera{});
    if (!way) return way.error();
    return std::vector<std::vector<Camera>>{*std::move(way)};
  }
  const auto features = object.find("features");
  if (features == object.end() || !features->is_array() || features->empty()) {
    return Error{"a FeatureCollection without features"};
  }
  std::vector<std::vector<Camera>> ways;
  for (std::size_t i = 0; i < features->size(); ++i) {
    const json& feature = (*features)[i];
    auto way = geojson_type(feature) == "Feature" ? read_feature(feature)
                                                  : Result<std::vector<Camera>>(Error{"not a Feature"});
    if (!way) return Error{fmt::format("{}: {}", feature_name(feature, i), way.error().message)};
    ways.push_back(*std::move(way));
  }
  return ways;
}

}  // namespace

Result<std::vector<std::vector<Camera>>> parse_flight(std::string_view text, const std::string& where) {
  const auto object = parse_geojson(text, where);
  if (!object) return object.error();
  auto ways = read_ways(*object);
  if (!ways) return Error{fmt::format("{}: {}", where, ways.error().message)};
  return ways;
}

Result<std::vector<std::vector<Camera>>> read_flight(const std::filesystem::path& path) {
  const auto text = read_geojson_text(path);
  if (!text) return text.error();
  return parse_flight(*text, path.string());
}

}  // namespace terrella
