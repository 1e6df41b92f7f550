#pragma once

#include <glm/mat3x3.hpp>

#include "geo/coordinates.h"
#include "geo/result.h"
#include "scene/utc_time.h"

namespace terrella {

/// Where Sun, Moon and stars stand at an instant, seen from the Earth's centre, in the Earth's ECEF axes.
///
/// Valid from 1950-01-01 to 2050-12-31. Error: Sun 0.02°, Moon 0.04° and 150 km, sidereal angle 0.01° (of that 0.004°
/// because UTC is taken for UT1), star positions 0.02° and what the star itself has moved since J2000. Sources:
/// J. Meeus, Astronomical Algorithms (2nd edition, 1998): chapters 12 (sidereal time), 21 (precession), 25 (Sun) and 47
/// (Moon, its 30 largest terms in longitude and 15 in latitude, of ELP-2000/82). Nutation (0.005°) is left out on both
/// sides, of the sidereal angle and of the positions, so that it all but cancels.
struct Almanac {
  EcefDir sun;                  ///< towards the Sun
  double sun_distance_m = 0.0;  ///< centre to centre
  Ecef moon;                    ///< the Moon's centre
  Angle sidereal;               ///< Greenwich mean sidereal angle, [0°, 360°)
  glm::dmat3 ecef_from_j2000;   ///< turns a catalogue's direction (mean equator and equinox of J2000)
};

/// The Sun's and the Moon's radius, metres (IAU 2015 nominal solar radius; IAU 2015 report, mean radius).
inline constexpr double kSunRadius_m = 6.957e8;
inline constexpr double kMoonRadius_m = 1.7374e6;

/// Fails for an instant outside the years above; the error says which years there are. thread: any
[[nodiscard]] Result<Almanac> almanac_at(UtcTime time);

}  // namespace terrella
