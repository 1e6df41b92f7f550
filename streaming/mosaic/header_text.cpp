#include "streaming/mosaic/header_text.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace terrella {
namespace {

/// Increase this number if the meaning of a field changes.
constexpr int kFactsVersion = 2;

/// JSON has no NaN, which may mean "no data".
nlohmann::json number_or_null(const std::optional<double>& number) {
  if (number && std::isnan(*number)) return "nan";
  return number ? nlohmann::json(*number) : nlohmann::json();
}

std::optional<double> number_of(const nlohmann::json& number) {
  if (number.is_string()) return std::numeric_limits<double>::quiet_NaN();
  return number.is_null() ? std::nullopt : std::optional(number.get<double>());
}

}  // namespace

std::string header_text(const PlacedFile& placed) {
  const MosaicFile& file = placed.file;
  const MosaicPlace& place = placed.place;
  const Affine& t = place.at.to_crs;
  const nlohmann::json text = {{"version", kFactsVersion},
                               {"bytes", file.bytes},
                               {"changed", file.changed_ns},
                               {"sizes", file.sizes},
                               {"kinds", {file.is_numbers, file.one_band, file.by_rows}},
                               {"unit", file.unit},
                               {"coding", {file.scale, file.offset}},
                               {"nodata", {number_or_null(file.nodata), number_or_null(file.own_nodata)}},
                               {"crs", place.at.crs},
                               {"place", {t.x0, t.x_per_column, t.x_per_row, t.y0, t.y_per_column, t.y_per_row}},
                               {"box", {place.box.west, place.box.south, place.box.east, place.box.north}},
                               {"centric", place.latitude == LatitudeKind::centric},
                               {"pixel", {place.pixel_units, place.unit_m}}};
  // A unit may contain bytes that are not UTF-8.
  return text.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::optional<PlacedFile> parse_header_text(const std::string& text) {
  const nlohmann::json facts = nlohmann::json::parse(text, nullptr, false);
  if (!facts.is_object() || facts.value("version", 0) != kFactsVersion) return {};
  try {
    PlacedFile placed;
    MosaicFile& file = placed.file;
    MosaicPlace& place = placed.place;
    Affine& t = place.at.to_crs;
    facts.at("bytes").get_to(file.bytes);
    facts.at("changed").get_to(file.changed_ns);
    facts.at("sizes").get_to(file.sizes);
    file.is_numbers = facts.at("kinds").at(0).get<bool>();
    file.one_band = facts.at("kinds").at(1).get<bool>();
    file.by_rows = facts.at("kinds").at(2).get<bool>();
    facts.at("unit").get_to(file.unit);
    facts.at("coding").at(0).get_to(file.scale);
    facts.at("coding").at(1).get_to(file.offset);
    file.nodata = number_of(facts.at("nodata").at(0));
    file.own_nodata = number_of(facts.at("nodata").at(1));
    facts.at("crs").get_to(place.at.crs);
    double* const numbers[] = {&t.x0, &t.x_per_column, &t.x_per_row, &t.y0, &t.y_per_column, &t.y_per_row};
    for (std::size_t i = 0; i < std::size(numbers); ++i) facts.at("place").at(i).get_to(*numbers[i]);
    double* const sides[] = {&place.box.west, &place.box.south, &place.box.east, &place.box.north};
    for (std::size_t i = 0; i < std::size(sides); ++i) facts.at("box").at(i).get_to(*sides[i]);
    place.latitude = facts.at("centric").get<bool>() ? LatitudeKind::centric : LatitudeKind::graphic;
    facts.at("pixel").at(0).get_to(place.pixel_units);
    facts.at("pixel").at(1).get_to(place.unit_m);
    if (file.sizes.empty() || !t.is_finite()) return {};
    return placed;
  } catch (const nlohmann::json::exception&) {
    return {};  // written by another version
  }
}

}  // namespace terrella
