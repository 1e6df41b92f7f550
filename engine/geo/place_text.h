#pragma once

#include <optional>
#include <string_view>

#include "geo/coordinates.h"

// thread: any, for all of this header
namespace terrella {

/// Reads a latitude: a number of degrees, or degrees, minutes and seconds as people write them: "47.4", "30N",
/// "47°24'30\"N", "47d24N". Nothing if the text is no latitude or is beyond ±90°.
[[nodiscard]] std::optional<double> read_latitude_deg(std::string_view text);
/// Reads a longitude in the same forms, "8°30'E". A plain number may be any finite number; other forms are within
/// ±540°.
[[nodiscard]] std::optional<double> read_longitude_deg(std::string_view text);
/// Reads a length in metres or, with the unit, in kilometres: "250", "250 m", "1000km".
[[nodiscard]] std::optional<double> read_length_m(std::string_view text);

/// Reads a place as people write it: latitude and longitude in one of the forms above, between them a comma or a blank,
/// or the letter of the latitude. A place with letters may name its longitude first. The height is 0; the longitude is
/// in [-180°, 180°].
[[nodiscard]] std::optional<Geodetic> read_place(std::string_view text);

}  // namespace terrella
