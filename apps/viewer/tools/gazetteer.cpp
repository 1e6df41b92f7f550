#include "apps/viewer/tools/gazetteer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/viewer/tools/folded_text.h"
#include "geo/ellipsoid.h"
#include "streaming/file_bytes.h"
#include "streaming/json_fields.h"

namespace terrella {
namespace {

constexpr std::size_t kMostGazetteerBytes = 32UL << 20;
constexpr double kPeoplePerKm2 = 62.0;  // mean of all land: 8.1e9 people on 1.3e8 km² without Antarctica

bool is_on_planet(const Geodetic& place) {
  return std::abs(place.lat.deg()) <= 90.0 && std::abs(place.lon.deg()) <= 360.0;
}

std::string text_of(const nlohmann::json& properties, const char* name) {
  const auto found = properties.find(name);
  return found != properties.end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::optional<NamedPlace> place_of(const nlohmann::json& feature) {
  if (!feature.is_object()) return {};
  const auto geometry = feature.find("geometry"), properties = feature.find("properties");
  if (geometry == feature.end() || properties == feature.end()) return {};
  if (!geometry->is_object() || !properties->is_object()) return {};
  const auto at = geometry->find("coordinates");
  if (at == geometry->end() || !at->is_array() || at->size() < 2 || !(*at)[0].is_number() || !(*at)[1].is_number()) {
    return {};
  }
  NamedPlace place;
  place.name = text_of(*properties, "name");
  if (place.name.empty()) place.name = text_of(*properties, "title");
  place.country = text_of(*properties, "country");
  if (place.country.empty()) place.country = text_of(*properties, "adm0name");
  place.folded = folded(place.name);
  place.place = {.lat = Angle::degrees((*at)[1].get<double>()), .lon = Angle::degrees((*at)[0].get<double>())};
  for (const char* name : {"pop_max", "population"}) {
    const auto people = properties->find(name);
    if (people != properties->end() && people->is_number()) place.people = people->get<double>();
  }
  if (place.folded.empty() || !is_on_planet(place.place)) return {};
  return place;
}

/// Marks the places whose numbers a list has. Throws nlohmann::json::exception.
void mark(const nlohmann::json& json, const char* list, bool NamedPlace::*what, std::vector<NamedPlace>& places) {
  const auto found = json.find(list);
  if (found == json.end()) return;
  for (const nlohmann::json& number : *found) {
    if (const auto k = number.get<std::size_t>(); k < places.size()) places[k].*what = true;
  }
}

/// Name and place of the columns `name`, `lat` and `lon` in a row. Throws nlohmann::json::exception.
NamedPlace place_of_row(const nlohmann::json& columns, std::size_t row) {
  NamedPlace place{.name = columns.at("name").at(row).get<std::string>()};
  place.folded = folded(place.name);
  place.place = {.lat = Angle::degrees(columns.at("lat").at(row).get<double>()),
                 .lon = Angle::degrees(columns.at("lon").at(row).get<double>())};
  return place;
}

/// Places of the columns `name`, `country`, `people`, `lat` and `lon`. Throws
/// nlohmann::json::exception.
std::vector<NamedPlace> places_of_columns(const nlohmann::json& json) {
  const auto &codes = json.at("country"), &countries = json.at("countries");
  std::vector<NamedPlace> places;
  for (std::size_t k = 0; k < json.at("name").size(); ++k) {
    NamedPlace& place = places.emplace_back(place_of_row(json, k));
    place.country = countries.at(codes.at(k).get<std::string>()).get<std::string>();
    place.people = json.at("people").at(k).get<double>();
  }
  mark(json, "capitals", &NamedPlace::is_capital, places);
  mark(json, "parts", &NamedPlace::is_part, places);
  return places;
}

/// Reads a JSON object.
Result<nlohmann::json> read_object(const std::filesystem::path& file) {
  const auto bytes = read_file(file, kMostGazetteerBytes);
  if (!bytes) return Error{bytes.error().message};
  return parse_json_object(as_text(*bytes), kMostGazetteerBytes, file.string());
}

}  // namespace

std::vector<NamedPlace> areas_of(const nlohmann::json& columns) {
  std::vector<NamedPlace> areas;
  for (std::size_t k = 0; k < columns.at("name").size(); ++k) {
    NamedPlace& area = areas.emplace_back(place_of_row(columns, k));
    area.area_km2 = columns.at("km2").at(k).get<double>();
  }
  return areas;
}

double rank_of(const NamedPlace& place) { return std::max(place.people, kPeoplePerKm2 * place.area_km2); }

Result<Gazetteer> Gazetteer::load(const std::filesystem::path& file) {
  const Result<nlohmann::json> json = read_object(file);
  if (!json) return json.error();
  Gazetteer gazetteer;
  if (json->contains("countries")) {
    try {
      gazetteer.places_ = places_of_columns(*json);
    } catch (const nlohmann::json::exception& wrong) {
      return Error{file.string() + ": not a list of cities: " + wrong.what()};
    }
  }
  if (const auto features = json->find("features"); features != json->end() && features->is_array()) {
    for (const nlohmann::json& feature : *features) {
      if (auto place = place_of(feature)) gazetteer.places_.push_back(*std::move(place));
    }
  }
  if (gazetteer.places_.empty()) return Error{file.string() + ": no GeoJSON of named places"};
  gazetteer.sort();
  return gazetteer;
}

void Gazetteer::sort() { std::ranges::stable_sort(places_, std::ranges::greater{}, &rank_of); }

Status Gazetteer::add_areas(const std::filesystem::path& map) {
  const Result<nlohmann::json> json = read_object(map);
  if (!json) return json.error();
  try {
    for (const char* kind : {"countries", "seas"}) {
      for (NamedPlace& area : areas_of(json->at(kind))) places_.push_back(std::move(area));
    }
  } catch (const nlohmann::json::exception& wrong) {
    return Error{map.string() + ": not a map: " + wrong.what()};
  }
  sort();
  return Done{};
}

std::vector<const NamedPlace*> Gazetteer::find(std::string_view text, std::size_t most) const {
  const std::string sought = folded(text);
  std::vector<const NamedPlace*> found, begins, has;
  if (sought.empty()) return found;
  for (const NamedPlace& place : places_) {
    const auto at = place.folded.find(sought);
    if (at == std::string::npos) continue;
    (at > 0 ? has : place.folded.size() > sought.size() ? begins : found).push_back(&place);
  }
  found.insert(found.end(), begins.begin(), begins.end());
  found.insert(found.end(), has.begin(), has.end());
  found.resize(std::min(found.size(), most));
  return found;
}

const NamedPlace* Gazetteer::near(const Geodetic& place, Angle distance) const {
  constexpr double kLargestCountry = 20.0;  // side of its area, in distances
  constexpr double kDegree_km = 111.2;      // on the mean sphere of the Earth, as the areas
  const glm::dvec3 here = Ellipsoid::normal(place.lat, place.lon).xyz;
  const double least = std::cos(distance.rad()), most_km = kLargestCountry * kDegree_km * distance.deg();
  const auto found = std::ranges::find_if(places_, [&](const NamedPlace& other) {
    return std::sqrt(other.area_km2) < most_km &&
           glm::dot(here, Ellipsoid::normal(other.place.lat, other.place.lon).xyz) >= least;
  });
  return found == places_.end() ? nullptr : &*found;
}

}  // namespace terrella
