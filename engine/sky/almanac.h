#pragma once

#include <glm/mat3x3.hpp>

#include "base/result.h"
#include "base/utc_time.h"
#include "geo/coordinates.h"

namespace terrella {

/// Places of Sun, Moon and stars at an instant, seen from the Earth's centre, in the Earth's ECEF axes.
///
/// Valid from 1950-01-01 to 2050-12-31. Error: Sun and stars 0.005°, Moon 0.015° and 70 km. UTC is used as UT1, which
/// contributes 0.004°: leap seconds keep the two within 0.9 s. The proper motion of a star since J2000 is not included.
/// ERFA, the free edition of the IAU's SOFA, computes the values: the Earth's orbit by epv00, the Moon by moon98 (J.
/// Meeus, Astronomical Algorithms, 2nd edition 1998, chapter 47), the Earth's axis and rotation by the IAU's models of
/// 2006 and 2000A.
struct Almanac {
  EcefDir sun;                  ///< direction to the Sun
  double sun_distance_m = 0.0;  ///< centre to centre
  Ecef moon;                    ///< the Moon's centre
  glm::dmat3 ecef_from_j2000;   ///< rotates a catalogue's direction (ICRS, or J2000's mean equator: 0.03" apart)
};

/// Radius of the Sun and of the Moon, metres (IAU 2015 nominal solar radius; IAU 2015 report, mean radius).
inline constexpr double kSunRadius_m = 6.957e8;
inline constexpr double kMoonRadius_m = 1.7374e6;

/// Computes the places at an instant. Fails outside the years above; the error names them. thread: any
[[nodiscard]] Result<Almanac> almanac_at(UtcTime time);

}  // namespace terrella
