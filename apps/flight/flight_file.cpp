#include "apps/flight/flight_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/flight/tour_flight.h"
#include "base/number.h"
#include "sky/almanac.h"
#include "streaming/objects/vector/kml_file.h"
#include "streaming/preload/geojson_text.h"

namespace terrella {
namespace {

using nlohmann::json;

constexpr double kHighest_m = 1e12;
constexpr double kLongest_s = 1e6;

/// PropertyRange of a number among the properties.
struct PropertyRange {
  double low, high;
  const char* unit;  ///< with a comma and a blank in front; empty for none
};
constexpr PropertyRange kPitch{-90.0, 90.0, ", degrees"}, kHeading{-360.0, 360.0, ", degrees"},
    kFov{0.01, 170.0, ", degrees"};
constexpr PropertyRange kOpacity{0.0, 1.0, ""}, kTime{0.0, kLongest_s, ", seconds"};
constexpr PropertyRange kDuration{1e-3, kLongest_s, ", seconds"};

/// Returns a property, or null for none.
const json* property(const json& properties, const char* name) {
  const auto value = properties.find(name);
  return value == properties.end() || value->is_null() ? nullptr : &*value;
}

Result<double> number_of(const json& value, const std::string& name, const PropertyRange& range) {
  if (value.is_number() && value.get<double>() >= range.low && value.get<double>() <= range.high) {
    return value.get<double>();
  }
  return Error{fmt::format("its property {} is not a number in {}...{}{}", name, range.low, range.high, range.unit)};
}

Result<std::optional<double>> optional_number(const json& properties, const char* name, const PropertyRange& range) {
  const json* value = property(properties, name);
  if (value == nullptr) return std::optional<double>();
  const auto number = number_of(*value, name, range);
  if (!number) return number.error();
  return std::optional(*number);
}

/// Fails unless the value is an array with an element for each position.
Status check_array(const json& value, const char* name, std::size_t positions) {
  if (value.is_array() && value.size() == positions) return Done{};
  return Error{fmt::format("its property {} is not an array of {} values, one for each position", name, positions)};
}

/// Reads an array of numbers; empty for none.
Result<std::vector<double>> read_numbers(const json& properties, const char* name, std::size_t positions,
                                         const PropertyRange& range) {
  std::vector<double> numbers;
  const json* value = property(properties, name);
  if (value == nullptr) return numbers;
  if (const Status array = check_array(*value, name, positions); !array) return array.error();
  numbers.reserve(positions);
  for (std::size_t i = 0; i < positions; ++i) {
    const auto number = number_of((*value)[i], fmt::format("{}[{}]", name, i), range);
    if (!number) return number.error();
    numbers.push_back(*number);
  }
  return numbers;
}

/// Reads an angle for all positions, or one for each. Empty for none.
Result<std::vector<double>> read_angles(const json& properties, const char* one, const char* each,
                                        std::size_t positions, const PropertyRange& range) {
  const auto single = optional_number(properties, one, range);
  if (!single) return single.error();
  auto several = read_numbers(properties, each, positions, range);
  if (!several || !*single) return several;
  if (!several->empty()) return Error{fmt::format("its properties {} and {}: give one of them", one, each)};
  return std::vector<double>(positions, **single);
}

Result<UtcTime> instant_of(const json& value, const std::string& name) {
  if (!value.is_string())
    return Error{fmt::format("its property {} is not a time such as \"2026-06-21T12:00Z\"", name)};
  const auto time = parse_utc(value.get<std::string>());
  if (!time) return Error{fmt::format("its property {}: {}", name, time.error().message)};
  const auto known = almanac_at(*time);
  return known ? time : Error{fmt::format("its property {}: {}", name, known.error().message)};
}

Status read_instants(const json& properties, std::vector<FlightMoment>& keyframes) {
  const json* one = property(properties, "time");
  const json* each = property(properties, "times");
  if (one != nullptr && each != nullptr) return Error{"its properties time and times: give one of them"};
  if (one == nullptr && each == nullptr) return Done{};
  if (each != nullptr) {
    if (Status array = check_array(*each, "times", keyframes.size()); !array) return array;
  }
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const auto instant =
        each != nullptr ? instant_of((*each)[i], fmt::format("times[{}]", i)) : instant_of(*one, "time");
    if (!instant) return instant.error();
    keyframes[i].sun = *instant;
  }
  return Done{};
}

/// Reads what the properties set, but not when.
Status read_looks(const json& properties, std::vector<FlightMoment>& keyframes) {
  const std::size_t count = keyframes.size();
  const auto pitches = read_angles(properties, "pitch", "pitches", count, kPitch);
  if (!pitches) return pitches.error();
  const auto headings = read_angles(properties, "heading", "headings", count, kHeading);
  if (!headings) return headings.error();
  const auto fov = optional_number(properties, "fov", kFov);
  if (!fov) return fov.error();
  const auto opacities = read_numbers(properties, "opacities", count, kOpacity);
  if (!opacities) return opacities.error();
  for (std::size_t i = 0; i < count; ++i) {
    Camera& camera = keyframes[i].camera;
    if (!pitches->empty()) camera.pitch = Angle::degrees((*pitches)[i]);
    if (!headings->empty()) camera.heading = Angle::degrees((*headings)[i]);
    if (*fov) camera.fov_y = Angle::degrees(**fov);
    if (!opacities->empty()) keyframes[i].surface_alpha = (*opacities)[i];
  }
  return read_instants(properties, keyframes);
}

/// Reads the times of the keyframes. A duration holds a single position.
Result<std::vector<double>> read_times(const json& properties, std::vector<FlightMoment>& keyframes) {
  const auto duration = optional_number(properties, "duration_s", kDuration);
  if (!duration) return duration.error();
  auto times = read_numbers(properties, "times_s", keyframes.size(), kTime);
  if (!times) return times;
  if (!times->empty()) {
    if (*duration) return Error{"its properties times_s and duration_s: give one of them"};
    if (std::ranges::adjacent_find(*times, std::greater_equal()) == times->end()) return times;
    return Error{"its property times_s does not ascend"};
  }
  if (keyframes.size() == 1 && *duration) keyframes.push_back(keyframes.front());
  std::vector<double> even = even_pace(keyframes);
  if (*duration && even.size() > 1) {
    const double factor = **duration / even.back();
    for (double& time : even) time *= factor;
  }
  return even;
}

/// Reads the positions of a LineString.
Result<std::vector<FlightMoment>> read_positions(const json& line) {
  if (geojson_type(line) != "LineString") return Error{"its geometry is not a LineString"};
  const auto positions = line.find("coordinates");
  if (positions == line.end() || !positions->is_array() || positions->empty()) {
    return Error{"a LineString without positions"};
  }
  std::vector<FlightMoment> keyframes;
  keyframes.reserve(positions->size());
  for (const json& position : *positions) {
    const auto place = geojson_position(position);
    if (!place) return place.error();
    if (position.size() < 3 || !position[2].is_number()) {
      return Error{fmt::format("the position {},{} has no height; the third coordinate is the eye's, metres",
                               place->lon_deg, place->lat_deg)};
    }
    FlightMoment keyframe;
    Geodetic& eye = keyframe.camera.eye;
    eye = {Angle::degrees(place->lat_deg), Angle::degrees(place->lon_deg), position[2].get<double>()};
    if (!(eye.height_m > 0.0) || !(eye.height_m <= kHighest_m)) {
      return Error{fmt::format("the height {} is not in 0...{} m", eye.height_m, kHighest_m)};
    }
    keyframes.push_back(keyframe);
  }
  return keyframes;
}

Result<FlightPath> read_path(const json& line, const json& properties) {
  auto keyframes = read_positions(line);
  if (!keyframes) return keyframes.error();
  if (Status looks = read_looks(properties, *keyframes); !looks) return looks.error();
  auto times = read_times(properties, *keyframes);
  if (!times) return times.error();
  return FlightPath(*std::move(times), *keyframes);
}

Result<FlightPath> read_feature(const json& feature) {
  if (geojson_type(feature) != "Feature") return Error{"not a Feature"};
  const auto geometry = feature.find("geometry");
  if (geometry == feature.end()) return Error{"a Feature without \"geometry\""};
  const json* properties = property(feature, "properties");
  return read_path(*geometry, properties != nullptr && properties->is_object() ? *properties : json::object());
}

Result<std::vector<FlightPath>> read_paths(const json& object) {
  const std::string type = geojson_type(object);
  if (type != "FeatureCollection") {
    auto path = type == "Feature" ? read_feature(object) : read_path(object, json::object());
    if (!path) return path.error();
    return std::vector<FlightPath>{*std::move(path)};
  }
  const auto features = object.find("features");
  if (features == object.end() || !features->is_array() || features->empty()) {
    return Error{"a FeatureCollection without features"};
  }
  std::vector<FlightPath> paths;
  paths.reserve(features->size());
  for (std::size_t i = 0; i < features->size(); ++i) {
    auto path = read_feature((*features)[i]);
    if (!path) return Error{fmt::format("{}: {}", feature_name((*features)[i], i), path.error().message)};
    paths.push_back(*std::move(path));
  }
  return paths;
}

}  // namespace

Result<std::vector<FlightPath>> parse_flight(std::string_view text, const std::string& where) {
  const auto object = parse_geojson(text, where);
  if (!object) return object.error();
  auto paths = read_paths(*object);
  if (!paths) return Error{fmt::format("{}: {}", where, paths.error().message)};
  return paths;
}

namespace {

Result<FlightFile> read_tour_file(const std::filesystem::path& path) {
  const auto file = KmlFile::open(path);
  if (!file) return file.error();
  auto text = file->read(file->document());
  if (!text) return Error{path.string() + ": " + text.error().message};
  const auto read = read_tours(*text);
  if (!read) return Error{path.string() + ": " + read.error().message};
  if (read->tours.empty()) {
    return Error{path.string() + ": it has no tour; a flight is a gx:Tour of a KML file, or a GeoJSON LineString"};
  }
  for (const KmlTour& tour : read->tours) {
    for (const TourView& at : tour.views) {
      const auto known = at.view.instant ? almanac_at(*at.view.instant) : Result<Almanac>(Error{});
      if (at.view.instant && !known) {
        return Error{fmt::format("{}: its tour {}: {}", path.string(), in_quotes(tour.name), known.error().message)};
      }
    }
  }
  FlightFile flight{flights_of(read->tours), *std::move(text)};
  for (const std::string& what : read->complaints) {
    flight.complaints.push_back(fmt::format("{}: {}", path.string(), what));
  }
  return flight;
}

}  // namespace

Result<FlightFile> read_flight(const std::filesystem::path& path) {
  if (is_kml_name(path)) return read_tour_file(path);
  auto text = read_geojson_text(path);
  if (!text) return text.error();
  auto paths = parse_flight(*text, path.string());
  if (!paths) return paths.error();
  return FlightFile{*std::move(paths), *std::move(text)};
}

}  // namespace terrella
