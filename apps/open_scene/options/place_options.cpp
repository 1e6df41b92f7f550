#include "apps/open_scene/options/place_options.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "apps/open_scene/options/option_checks.h"
#include "apps/process/console.h"
#include "base/number.h"

namespace terrella {
namespace {

/// Largest longitude of bounds, degrees: pictures from 0 to 360 are frequent.
constexpr double kMostLongitude_deg = 360.0;

Status check_words(const PlaceWords& words) {
  if (!words.bounds) return Done{};
  const CrsBounds& b = *words.bounds;
  if (!words.crs.empty()) {
    if (b.west < b.east && b.south < b.north) return Done{};
    return Error{fmt::format("{}: with --crs it takes WEST < EAST and SOUTH < NORTH, in the units of that system",
                             bounds_text(b))};
  }
  const bool longitudes = std::abs(b.west) <= kMostLongitude_deg && std::abs(b.east) <= kMostLongitude_deg &&
                          b.west != b.east && b.east - b.west <= 360.0 && b.west - b.east < 360.0;
  if (longitudes && b.south >= -90.0 && b.north <= 90.0 && b.south < b.north) return Done{};
  return Error{
      fmt::format("{}: it takes WEST and EAST in -360...360, at most 360 apart (WEST > EAST crosses 180 "
                  "degrees), and SOUTH < NORTH in -90...90",
                  bounds_text(b))};
}

}  // namespace

Result<CrsBounds> parse_bounds(const std::string& text) {
  std::array<double, 4> sides{};
  const auto pieces = split_at_commas(text);
  bool read = pieces.size() == sides.size();
  for (std::size_t i = 0; read && i < sides.size(); ++i) {
    const auto number = read_number(pieces[i]);
    read = number.has_value();
    sides[i] = number.value_or(0.0);
  }
  if (!read) return Error{fmt::format("{} is not W,S,E,N; write four numbers, as 5,43,17,49", in_quotes(text))};
  return CrsBounds{sides[0], sides[1], sides[2], sides[3]};
}

std::string bounds_text(const CrsBounds& bounds) {
  return fmt::format("{},{},{},{}", bounds.west, bounds.south, bounds.east, bounds.north);
}

void add_place_options(CLI::App& command, PlaceWords& words) {
  command
      .add_option("--crs", words.crs,
                  "Set the coordinate system of a picture that does not state it, or states a wrong one, or of a URL "
                  "template's "
                  "tiles: a code, a PROJ string or WKT")
      ->type_name("CRS");
  CLI::Option* bounds = command.add_option_function<std::string>(
      "--bounds", [&words](const std::string& text) { words.bounds = parsed_or_throw("--bounds", parse_bounds(text)); },
      "Set a picture's bounds, in degrees (W > E crosses 180) or in units of --crs (default: as stated by the picture "
      "or files beside it, else the whole planet); with --crs also those of a URL template's tiles");
  bounds->type_name("W,S,E,N");
  command.add_option("--west", words.west_deg, "Set the longitude at which a picture of the whole planet begins")
      ->check(number_in(-kMostLongitude_deg, kMostLongitude_deg))
      ->excludes(bounds)
      ->type_name("DEGREES");
  command.parse_complete_callback([&words] { check_place(words); });
}

void check_place(const PlaceWords& words) {
  if (const Status sane = check_words(words); !sane) throw CLI::ValidationError("--bounds", sane.error().message);
}

}  // namespace terrella
