#include "sky/almanac.h"

#include <erfa.h>
#include <erfam.h>

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <string>

namespace terrella {
namespace {

constexpr int kFirstYear = 1950;
constexpr int kLastYear = 2050;

double days_since_j2000(UtcTime time) {
  using namespace std::chrono;
  constexpr UtcTime j2000 = sys_days{year{2000} / January / 1} + hours{12};
  return duration<double, days::period>(time - j2000).count();
}

// ERFA applies leap seconds from 1960 to the last one in its table. Up to 2050 the missing ones may add up to 20 s, in
// which the Moon moves 0.003°.
double tt_days(double utc_days) {
  double tai_high = 0.0, tai_low = 0.0, tt_high = 0.0, tt_low = 0.0;
  eraUtctai(ERFA_DJ00, utc_days, &tai_high, &tai_low);
  eraTaitt(tai_high, tai_low, &tt_high, &tt_low);
  return (tt_high - ERFA_DJ00) + tt_low;
}

// ERFA stores matrices by rows, GLM by columns.
glm::dmat3 ecef_from_gcrs(double tt_days, double ut1_days) {
  double rows[3][3];
  eraC2t06a(ERFA_DJ00, tt_days, ERFA_DJ00, ut1_days, 0.0, 0.0, rows);
  return glm::transpose(glm::make_mat3(&rows[0][0]));
}

struct SunPlace {
  glm::dvec3 direction_gcrs;
  double distance_m;
};

// The Earth's motion shifts the Sun forward by velocity / c, 20". The neglected terms of relativity are 0.001".
SunPlace sun_place(double tt_days) {
  double heliocentric[2][3], barycentric[2][3];  // place and velocity of the Earth, in au and days
  eraEpv00(ERFA_DJ00, tt_days, heliocentric, barycentric);
  const glm::dvec3 to_sun_au = -glm::make_vec3(heliocentric[0]);
  const glm::dvec3 velocity_c = glm::make_vec3(barycentric[1]) * (ERFA_AULT / ERFA_DAYSEC);
  return {glm::normalize(glm::normalize(to_sun_au) + velocity_c), glm::length(to_sun_au) * ERFA_DAU};
}

glm::dvec3 moon_place_gcrs_m(double tt_days) {
  double geocentric_au[2][3];
  eraMoon98(ERFA_DJ00, tt_days, geocentric_au);
  return glm::make_vec3(geocentric_au[0]) * ERFA_DAU;
}

}  // namespace

Result<Almanac> almanac_at(UtcTime time) {
  const std::chrono::year_month_day date{std::chrono::floor<std::chrono::days>(time)};
  const int year = static_cast<int>(date.year());
  if (year < kFirstYear || year > kLastYear) {
    return Error{"there is no almanac for the year " + std::to_string(year) +
                 ": the formulas for Sun and Moon hold from " + std::to_string(kFirstYear) + " to " +
                 std::to_string(kLastYear)};
  }
  const double utc = days_since_j2000(time);
  const double tt = tt_days(utc);
  const glm::dmat3 to_ecef = ecef_from_gcrs(tt, utc);
  const SunPlace sun = sun_place(tt);
  return Almanac{.sun = {to_ecef * sun.direction_gcrs},
                 .sun_distance_m = sun.distance_m,
                 .moon = {to_ecef * moon_place_gcrs_m(tt)},
                 .ecef_from_j2000 = to_ecef};
}

}  // namespace terrella
