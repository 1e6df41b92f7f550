#pragma once

#include <glm/mat3x3.hpp>

#include "base/result.h"
#include "geo/coordinates.h"
#include "sky/utc_time.h"

namespace terrella {

/// Where Sun, Moon and stars stand at an instant, seen from the Earth's centre, in the Earth's ECEF axes.
///
/// Valid from 1950-01-01 to 2050-12-31. Error: Sun and stars 0.005°, Moon 0.015° and 70 km. Of that, 0.004° is because
/// UTC is taken for UT1, from which leap seconds keep it by less than 0.9 s. A star's own motion since J2000 comes on
/// top. ERFA, the free edition of the IAU's SOFA, works it out: the Earth's orbit by epv00, the Moon by moon98 (J.
/// Meeus, Astronomical Algorithms, 2nd edition 1998, chapter 47), the Earth's axis and rotation by the IAU's models of
/// 2006 and 2000A.
struct Almanac {
  EcefDir sun;                  ///< towards the Sun
  double sun_distance_m = 0.0;  ///< centre to centre
  Ecef moon;                    ///< the Moon's centre
  glm::dmat3 ecef_from_j2000;   ///< turns a catalogue's direction (ICRS, or J2000's mean equator: 0.03" apart)
};

/// The Sun's and the Moon's radius, metres (IAU 2015 nominal solar radius; IAU 2015 report, mean radius).
inline constexpr double kSunRadius_m = 6.957e8;
inline constexpr double kMoonRadius_m = 1.7374e6;

/// Fails for an instant outside the years above; the error says which years there are. thread: any
[[nodiscard]] Result<Almanac> almanac_at(UtcTime time);

}  // namespace terrella
