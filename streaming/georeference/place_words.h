#pragma once

#include <optional>
#include <string>

namespace terrella {

/// A rectangle in units of a coordinate system.
struct CrsBounds {
  double west = 0.0, south = 0.0, east = 0.0, north = 0.0;
  bool operator==(const CrsBounds&) const = default;
};

/// The user's statements about a picture's place. Each replaces the statement of the picture and the files beside it.
struct PlaceWords {
  std::string crs{};                  ///< text for Crs::open()
  std::optional<CrsBounds> bounds{};  ///< in units of `crs`; in degrees without `crs`, where east < west crosses ±180°
  std::optional<double> west_deg{};   ///< the picture is a whole planet from this longitude on; excludes `bounds`

  [[nodiscard]] bool say_place() const { return bounds || west_deg; }
  bool operator==(const PlaceWords&) const = default;
};

}  // namespace terrella
