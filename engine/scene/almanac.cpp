#include "scene/almanac.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

namespace terrella {
namespace {

constexpr double kAstronomicalUnit_m = 1.495978707e11;
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr int kFirstYear = 1950;
constexpr int kLastYear = 2050;

using JulianCenturies = double;  // since J2000.0, 2000-01-01T12:00

double days_since_j2000(UtcTime time) {
  using namespace std::chrono;
  constexpr UtcTime j2000 = sys_days{year{2000} / January / 1} + hours{12};
  return duration<double, days::period>(time - j2000).count();
}

// TT - UTC: straight lines through 29.2 s (1950), 63.8 s (2000) and 69.2 s (2025). Within 2 s of what was measured, and
// of what may come by 2050 within 10 s, in which the Moon moves 0.002°.
double tt_minus_utc_s(double days) {
  const double years = days / 365.25;
  return 63.8 + years * (years < 0.0 ? 0.69 : 0.216);
}

double degrees_0_360(double deg) { return deg - 360.0 * std::floor(deg / 360.0); }
double sin_deg(double deg) { return std::sin(deg * kDegree); }
double cos_deg(double deg) { return std::cos(deg * kDegree); }

// Meeus (12.4), mean sidereal time; days of UT1.
double greenwich_sidereal_deg(double days) {
  const double t = days / 36525.0;
  return degrees_0_360(280.46061837 + 360.98564736629 * days + 0.000387933 * t * t);
}

// Meeus (22.2), mean obliquity.
double obliquity_deg(JulianCenturies t) { return 23.4392911 - 0.0130042 * t; }

glm::dvec3 from_ecliptic(double lon_deg, double lat_deg, double obliquity) {
  const double x = cos_deg(lat_deg) * cos_deg(lon_deg);
  const double y = cos_deg(lat_deg) * sin_deg(lon_deg);
  const double z = sin_deg(lat_deg);
  const double c = cos_deg(obliquity), s = sin_deg(obliquity);
  return {x, c * y - s * z, s * y + c * z};
}

struct SunPlace {
  double lon_deg;
  double distance_m;
};

// Meeus chapter 25, lower accuracy; the longitude is apparent but for nutation.
SunPlace sun_place(JulianCenturies t) {
  const double mean_lon = 280.46646 + (36000.76983 + 0.0003032 * t) * t;
  const double anomaly = 357.52911 + (35999.05029 - 0.0001537 * t) * t;
  const double e = 0.016708634 - 0.000042037 * t;
  const double center = (1.914602 - 0.004817 * t) * sin_deg(anomaly) +
                        (0.019993 - 0.000101 * t) * sin_deg(2.0 * anomaly) + 0.000289 * sin_deg(3.0 * anomaly);
  const double radius_au = 1.000001018 * (1.0 - e * e) / (1.0 + e * cos_deg(anomaly + center));
  constexpr double aberration_deg = 0.00569;
  return {mean_lon + center - aberration_deg, radius_au * kAstronomicalUnit_m};
}

/// Multiples of the Moon's mean elongation D, the Sun's and the Moon's mean anomaly M and M', the argument of latitude
/// F; and the terms in 1e-6 degree and in metres.
struct MoonTerm {
  int d, m, mm, f;
  double sine_udeg, cosine_m;
};

// Meeus, table 47.A.
constexpr std::array<MoonTerm, 30> kLongitudeAndDistance = {{
    {0, 0, 1, 0, 6288774, -20905355}, {2, 0, -1, 0, 1274027, -3699111}, {2, 0, 0, 0, 658314, -2955968},
    {0, 0, 2, 0, 213618, -569925},    {0, 1, 0, 0, -185116, 48888},     {0, 0, 0, 2, -114332, -3149},
    {2, 0, -2, 0, 58793, 246158},     {2, -1, -1, 0, 57066, -152138},   {2, 0, 1, 0, 53322, -170733},
    {2, -1, 0, 0, 45758, -204586},    {0, 1, -1, 0, -40923, -129620},   {1, 0, 0, 0, -34720, 108743},
    {0, 1, 1, 0, -30383, 104755},     {2, 0, 0, -2, 15327, 10321},      {0, 0, 1, 2, -12528, 0},
    {0, 0, 1, -2, 10980, 79661},      {4, 0, -1, 0, 10675, -34782},     {0, 0, 3, 0, 10034, -23210},
    {4, 0, -2, 0, 8548, -21636},      {2, 1, -1, 0, -7888, 24208},      {2, 1, 0, 0, -6766, 30824},
    {1, 0, -1, 0, -5163, -8379},      {1, 1, 0, 0, 4987, -16675},       {2, -1, 1, 0, 4036, -12831},
    {2, 0, 2, 0, 3994, -10445},       {4, 0, 0, 0, 3861, -11650},       {2, 0, -3, 0, 3665, 14403},
    {0, 1, -2, 0, -2689, -7003},      {2, 0, -1, 2, -2602, 0},          {2, -1, -2, 0, 2390, 10056},
}};

// Meeus, table 47.B.
constexpr std::array<MoonTerm, 15> kLatitude = {{
    {0, 0, 0, 1, 5128122, 0},
    {0, 0, 1, 1, 280602, 0},
    {0, 0, 1, -1, 277693, 0},
    {2, 0, 0, -1, 173237, 0},
    {2, 0, -1, 1, 55413, 0},
    {2, 0, -1, -1, 46271, 0},
    {2, 0, 0, 1, 32573, 0},
    {0, 0, 2, 1, 17198, 0},
    {2, 0, 1, -1, 9266, 0},
    {0, 0, 2, -1, 8822, 0},
    {2, -1, 0, -1, 8216, 0},
    {2, 0, -2, -1, 4324, 0},
    {2, 0, 1, 1, 4200, 0},
    {2, 1, 0, -1, -3359, 0},
    {2, -1, -1, 1, 2463, 0},
}};

struct MoonArguments {
  double d, m, mm, f, e;
  [[nodiscard]] double angle(const MoonTerm& term) const { return term.d * d + term.m * m + term.mm * mm + term.f * f; }
  // The Earth's orbit grows rounder, and terms with M shrink with it: Meeus (47.6).
  [[nodiscard]] double weight(const MoonTerm& term) const { return term.m == 0 ? 1.0 : e; }
};

glm::dvec3 moon_place_m(JulianCenturies t) {
  const MoonArguments at{.d = 297.8501921 + (445267.1114034 - 0.0018819 * t) * t,
                         .m = 357.5291092 + (35999.0502909 - 0.0001536 * t) * t,
                         .mm = 134.9633964 + (477198.8675055 + 0.0087414 * t) * t,
                         .f = 93.2720950 + (483202.0175233 - 0.0036539 * t) * t,
                         .e = 1.0 - 0.002516 * t};
  double lon_deg = 218.3164477 + (481267.88123421 - 0.0015786 * t) * t;
  double lat_deg = 0.0;
  double distance_m = 385000560.0;
  for (const MoonTerm& term : kLongitudeAndDistance) {
    lon_deg += 1e-6 * term.sine_udeg * at.weight(term) * sin_deg(at.angle(term));
    distance_m += term.cosine_m * at.weight(term) * cos_deg(at.angle(term));
  }
  for (const MoonTerm& term : kLatitude) lat_deg += 1e-6 * term.sine_udeg * at.weight(term) * sin_deg(at.angle(term));
  return distance_m * from_ecliptic(lon_deg, lat_deg, obliquity_deg(t));
}

// Rotations of the axes, as astronomers write them.
glm::dmat3 axes_turned_about_z(double deg) {
  const double c = cos_deg(deg), s = sin_deg(deg);
  return {{c, -s, 0.0}, {s, c, 0.0}, {0.0, 0.0, 1.0}};
}
glm::dmat3 axes_turned_about_y(double deg) {
  const double c = cos_deg(deg), s = sin_deg(deg);
  return {{c, 0.0, s}, {0.0, 1.0, 0.0}, {-s, 0.0, c}};
}

// Meeus (21.3), from J2000 to the mean equator and equinox of date.
glm::dmat3 date_from_j2000(JulianCenturies t) {
  const double zeta = (2306.2181 + 0.30188 * t) * t / 3600.0;
  const double z = (2306.2181 + 1.09468 * t) * t / 3600.0;
  const double theta = (2004.3109 - 0.42665 * t) * t / 3600.0;
  return axes_turned_about_z(-z) * axes_turned_about_y(theta) * axes_turned_about_z(-zeta);
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
  const double days = days_since_j2000(time);
  const JulianCenturies t = (days + tt_minus_utc_s(days) / 86400.0) / 36525.0;
  const double sidereal = greenwich_sidereal_deg(days);
  const glm::dmat3 ecef_from_date = axes_turned_about_z(sidereal);
  const SunPlace sun = sun_place(t);
  return Almanac{.sun = {ecef_from_date * from_ecliptic(sun.lon_deg, 0.0, obliquity_deg(t))},
                 .sun_distance_m = sun.distance_m,
                 .moon = {ecef_from_date * moon_place_m(t)},
                 .sidereal = Angle::degrees(sidereal),
                 .ecef_from_j2000 = ecef_from_date * date_from_j2000(t)};
}

}  // namespace terrella
