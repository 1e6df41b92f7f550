#include "geo/place_text.h"

#include <GeographicLib/Constants.hpp>
#include <GeographicLib/DMS.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "base/number.h"

namespace terrella {
namespace {

using GeographicLib::DMS;

std::optional<double> read_degrees(std::string_view text, DMS::flag axis) {
  if (const auto plain = read_number(text)) return plain;
  std::string packed(text);
  std::erase(packed, ' ');
  try {
    DMS::flag found = DMS::NONE;
    const double degrees = DMS::Decode(packed, found);
    const bool fits = std::isfinite(degrees) && (found == DMS::NONE || found == axis);
    return fits ? std::optional(degrees) : std::nullopt;
  } catch (const GeographicLib::GeographicErr&) {
    return {};
  }
}

/// Splits a place into two texts: at the comma, after the first letter of a direction, or at the only blank.
std::optional<std::pair<std::string_view, std::string_view>> halves(std::string_view text) {
  text = trimmed(text);
  if (const auto comma = text.find(','); comma != text.npos) return {{text.substr(0, comma), text.substr(comma + 1)}};
  const auto letter = text.find_first_of("NSEWnsew");
  if (letter != text.npos && letter > 0 && letter + 1 < text.size()) {
    return {{text.substr(0, letter + 1), text.substr(letter + 1)}};
  }
  const auto blank = text.find(' ');
  if (blank == text.npos || trimmed(text.substr(blank)).find(' ') != text.npos) return {};
  return {{text.substr(0, blank), text.substr(blank + 1)}};
}

}  // namespace

std::optional<double> read_latitude_deg(std::string_view text) {
  const auto degrees = read_degrees(text, DMS::LATITUDE);
  return degrees && std::abs(*degrees) <= 90.0 ? degrees : std::nullopt;
}

std::optional<double> read_longitude_deg(std::string_view text) { return read_degrees(text, DMS::LONGITUDE); }

std::optional<double> read_length_m(std::string_view text) {
  text = trimmed(text);
  double unit_m = 1.0;
  if (text.ends_with("km")) {
    unit_m = 1000.0, text.remove_suffix(2);
  } else if (text.ends_with('m')) {
    text.remove_suffix(1);
  }
  const auto number = read_number(text);
  return number && std::isfinite(*number * unit_m) ? std::optional(*number * unit_m) : std::nullopt;
}

std::optional<Geodetic> read_place(std::string_view text) {
  const auto parts = halves(text);
  if (!parts) return {};
  auto lat = read_latitude_deg(parts->first), lon = read_longitude_deg(parts->second);
  const bool named = text.find_first_of("NSEWnsew") != text.npos;
  if (named && (!lat || !lon)) lat = read_latitude_deg(parts->second), lon = read_longitude_deg(parts->first);
  if (!lat || !lon) return {};
  return Geodetic{.lat = Angle::degrees(*lat), .lon = Angle::degrees(std::remainder(*lon, 360.0))};
}

}  // namespace terrella
