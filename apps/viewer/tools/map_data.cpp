#include "apps/viewer/tools/map_data.h"

#include <utf8proc.h>

#include <CLI/Error.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/process/data_dir.h"
#include "apps/viewer/tools/gazetteer.h"
#include "base/code_points.h"
#include "streaming/file_bytes.h"
#include "streaming/json_fields.h"

namespace terrella {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostMapBytes = 8UL << 20, kMostFontBytes = 32UL << 20;
constexpr double kPeoplePerMetre = 320.0;  // to be shown, a place has this many people for each metre of a pixel
constexpr double kCapital = 4.0;           // a capital counts as a place with this many times its people
constexpr double kPart = 0.1;              // the same for a part of a city
constexpr double kBig = 8.0e6;             // people of a city whose name is bold, as a capital's
constexpr double kCharacter_em = 0.6;      // mean width of a capital letter
constexpr double kCountryShare = 0.5;      // a country's name is at most twice as wide as the country
constexpr double kSeaShare = 1.0;          // a sea's name is at most as wide as the sea
constexpr double kOceanShare = 0.5;        // an ocean's name is at most twice as wide as the ocean
constexpr double kOcean_km2 = 1.0e7;       // least area of an ocean
constexpr float kPlace_px = 13.0F;         // size of the names of places
constexpr double kCountryRank = 1.0e6;     // rank of a km², so that all but the smallest countries come before places

std::string mapped(std::string_view text, int how) {
  utf8proc_uint8_t* bytes = nullptr;
  const auto length =
      utf8proc_map(reinterpret_cast<const utf8proc_uint8_t*>(text.data()), static_cast<utf8proc_ssize_t>(text.size()),
                   &bytes, static_cast<utf8proc_option_t>(how));
  if (length < 0) return std::string(text);
  std::string result(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(length));
  std::free(bytes);
  return result;
}

/// Joins letters with their marks, as fonts have them.
std::string composed(std::string_view text) { return mapped(text, UTF8PROC_STABLE | UTF8PROC_COMPOSE); }

std::string in_capitals(std::string_view text) {
  std::string capitals;
  for (const char32_t letter : code_points(text)) {
    utf8proc_uint8_t bytes[4];
    const auto length = utf8proc_encode_char(utf8proc_toupper(static_cast<utf8proc_int32_t>(letter)), bytes);
    capitals.append(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(length));
  }
  return capitals;
}

/// Lines of whole numbers: the first place, then steps, in fractions of a degree.
void add_lines(const Json& map, const char* field, MapLineKind kind, std::vector<MapLine>& lines) {
  const double lon_step = map.at("degrees").at(0).get<double>(), lat_step = map.at("degrees").at(1).get<double>();
  const double west = map.at("origin").at(0).get<double>(), south = map.at("origin").at(1).get<double>();
  for (const Json& steps : map.at(field)) {
    MapLine line{.kind = kind, .places = {}};
    double lon = 0.0, lat = 0.0;
    for (std::size_t k = 0; k + 1 < steps.size(); k += 2) {
      lon += steps[k].get<double>(), lat += steps[k + 1].get<double>();
      line.places.push_back(
          {.lat = Angle::degrees(south + lat * lat_step), .lon = Angle::degrees(west + lon * lon_step)});
    }
    lines.push_back(std::move(line));
  }
}

/// A name of an area is written larger and wider if the area is larger.
struct AreaLook {
  double least_km2;
  float text_px;
  float spacing_px;
};
constexpr std::array<AreaLook, 4> kCountryLooks{
    {{3.0e6, 16.0F, 4.0F}, {5.0e5, 15.0F, 3.0F}, {5.0e4, 14.0F, 2.0F}, {0.0, 13.0F, 1.0F}}};
constexpr std::array<AreaLook, 4> kSeaLooks{
    {{kOcean_km2, 16.0F, 5.0F}, {1.0e6, 15.0F, 3.0F}, {1.5e5, 14.0F, 2.0F}, {0.0, 13.0F, 1.0F}}};

/// A dark halo that fades, legible on snow too.
LabelLook faded(float text_px) {
  return {.text_px = text_px, .halo = {0, 0, 0, 230}, .halo_px = 2.6F, .halo_blur_px = 1.6F};
}

/// Countries are written in upright capitals; seas are slanted, and oceans thin and in capitals too.
void add_areas(const Json& columns, bool are_seas, std::vector<MapName>& names) {
  for (const NamedPlace& area : areas_of(columns)) {
    const bool is_ocean = are_seas && area.area_km2 >= kOcean_km2;
    const double share = is_ocean ? kOceanShare : are_seas ? kSeaShare : kCountryShare;
    const auto& looks = are_seas ? kSeaLooks : kCountryLooks;
    const AreaLook& of_size =
        *std::ranges::find_if(looks, [&](const AreaLook& one) { return area.area_km2 >= one.least_km2; });
    MapName name{.text = is_ocean || !are_seas ? in_capitals(composed(area.name)) : composed(area.name),
                 .place = area.place};
    name.rank = kCountryRank * area.area_km2;
    name.is_area = true;
    name.color = are_seas ? ObjectColor{180, 214, 246} : ObjectColor{255, 236, 200};
    name.look = faded(of_size.text_px);
    name.look.letter_spacing_em = of_size.spacing_px / of_size.text_px;
    name.look.slanted = are_seas;
    if (is_ocean) name.look.weight = TextWeight::light;
    const double letter_px = kCharacter_em * double(of_size.text_px) + double(of_size.spacing_px);
    name.widest_m = 1000.0 * std::sqrt(area.area_km2) / (share * letter_px * double(code_points(name.text).size()));
    names.push_back(std::move(name));
  }
}

Status add_map(const std::filesystem::path& file, MapData& data) {
  const auto bytes = read_file(file, kMostMapBytes);
  if (!bytes) return Error{bytes.error().message};
  const std::string_view text = as_text(*bytes);
  const Result<Json> map = parse_json_object(text, kMostMapBytes, file.string());
  if (!map) return map.error();
  try {
    add_lines(*map, "coasts", MapLineKind::coast, data.lines);
    add_lines(*map, "borders", MapLineKind::border, data.lines);
    add_areas(map->at("countries"), false, data.names);
    add_areas(map->at("seas"), true, data.names);
    data.attributions.push_back(map->at("attribution").get<std::string>());
  } catch (const Json::exception& wrong) {
    return Error{file.string() + ": not a map: " + wrong.what()};
  }
  return Done{};
}

/// Places without a number of people are shown at any distance, the first ones before the others.
Status add_places(const std::filesystem::path& file, MapData& data) {
  const auto gazetteer = Gazetteer::load(file);
  if (!gazetteer) return gazetteer.error();
  double rank = 1.0;
  for (const NamedPlace& place : gazetteer->places()) {
    const double people = place.people * (place.is_capital ? kCapital : place.is_part ? kPart : 1.0);
    rank *= 1.0 - 1e-6;
    LabelLook look = faded(kPlace_px);
    if (place.is_capital || place.people >= kBig) look.weight = TextWeight::bold;
    data.names.push_back({.text = composed(place.name),
                          .place = place.place,
                          .rank = people > 0.0 ? people : rank,
                          .widest_m = people > 0.0 ? people / kPeoplePerMetre : HUGE_VAL,
                          .color = {236, 242, 248},
                          .look = look});
  }
  return Done{};
}

}  // namespace

std::string without_marks(std::string_view utf8) {
  return mapped(utf8, UTF8PROC_STABLE | UTF8PROC_DECOMPOSE | UTF8PROC_COMPAT | UTF8PROC_STRIPMARK | UTF8PROC_LUMP);
}

bool has_map(const Body& body, const std::filesystem::path& places) {
  return body.name == earth().name || !places.empty();
}

void check_map(const SceneOptions& options, const Body& body) {
  if (!options.map.value_or(false) || has_map(body, options.places)) return;
  throw CLI::ValidationError(
      "--map", "the included map is of the Earth; names of another body come from --places FILE, lines from --objects");
}

Result<MapData> load_map(const Body& body, const std::filesystem::path& places) {
  MapData data;
  try {
    auto font = read_file(data_file("DejaVuSans.ttf"), kMostFontBytes);
    if (!font) return Error{font.error().message};
    data.font = *std::move(font);
    if (body.name == earth().name) {
      if (Status added = add_map(data_file("map.json"), data); !added) return added.error();
      if (places.empty()) data.attributions.emplace_back("GeoNames");
    }
    if (Status added = add_places(places.empty() ? data_file("cities.json") : places, data); !added)
      return added.error();
  } catch (const BrokenInstallation& broken) {
    return Error{broken.what()};
  }
  return data;
}

}  // namespace terrella
