#include "apps/viewer/tools/gazetteer.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "streaming/file_bytes.h"
#include "streaming/json_fields.h"

namespace terrella {
namespace {

constexpr std::size_t kMostGazetteerBytes = 32UL << 20;

std::string folded(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    result += byte < 0x80 ? static_cast<char>(std::tolower(byte)) : c;
  }
  const auto first = result.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return result.substr(first, result.find_last_not_of(' ') - first + 1);
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
  place.country = text_of(*properties, "adm0name");
  const std::string ascii = text_of(*properties, "nameascii");
  place.folded = folded(ascii.empty() ? place.name : ascii);
  place.place = {.lat = Angle::degrees((*at)[1].get<double>()), .lon = Angle::degrees((*at)[0].get<double>())};
  const auto people = properties->find("pop_max");
  if (people != properties->end() && people->is_number()) place.people = people->get<double>();
  const bool on_planet = std::abs(place.place.lat.deg()) <= 90.0 && std::abs(place.place.lon.deg()) <= 180.0;
  if (place.folded.empty() || !on_planet) return {};
  return place;
}

}  // namespace

Result<Gazetteer> Gazetteer::load(const std::filesystem::path& file) {
  const auto bytes = read_file(file, kMostGazetteerBytes);
  if (!bytes) return Error{bytes.error().message};
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  const Result<nlohmann::json> json = parse_json_object(text, kMostGazetteerBytes, file.string());
  if (!json) return json.error();
  Gazetteer gazetteer;
  if (const auto features = json->find("features"); features != json->end() && features->is_array()) {
    for (const nlohmann::json& feature : *features) {
      if (auto place = place_of(feature)) gazetteer.places_.push_back(*std::move(place));
    }
  }
  if (gazetteer.places_.empty()) return Error{file.string() + ": no GeoJSON of named places"};
  std::ranges::stable_sort(gazetteer.places_, std::ranges::greater{}, &NamedPlace::people);
  return gazetteer;
}

std::vector<const NamedPlace*> Gazetteer::find(std::string_view text, std::size_t most) const {
  const std::string sought = folded(text);
  std::vector<const NamedPlace*> begins, has;
  if (sought.empty()) return begins;
  for (const NamedPlace& place : places_) {
    const auto at = place.folded.find(sought);
    if (at == 0 || place.name.starts_with(text)) {
      begins.push_back(&place);
    } else if (at != std::string::npos) {
      has.push_back(&place);
    }
  }
  begins.insert(begins.end(), has.begin(), has.end());
  begins.resize(std::min(begins.size(), most));
  return begins;
}

}  // namespace terrella
