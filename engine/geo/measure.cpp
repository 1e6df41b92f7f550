#include "geo/measure.h"

#include <GeographicLib/GeodesicExact.hpp>
#include <GeographicLib/GeodesicLineExact.hpp>
#include <GeographicLib/PolygonArea.hpp>
#include <algorithm>
#include <cmath>

namespace terrella {
namespace {

double latitude_deg(const Geodetic& place) { return std::clamp(place.lat.deg(), -90.0, 90.0); }

GeographicLib::GeodesicExact geodesics_of(const Ellipsoid& ellipsoid) { return {ellipsoid.a_m(), ellipsoid.f()}; }

double distance_m(const GeographicLib::GeodesicExact& geodesics, const Geodetic& from, const Geodetic& to) {
  double metres = 0.0;
  geodesics.Inverse(latitude_deg(from), from.lon.deg(), latitude_deg(to), to.lon.deg(), metres);
  return metres;
}

}  // namespace

double geodesic_m(const Ellipsoid& ellipsoid, const Geodetic& from, const Geodetic& to) {
  return distance_m(geodesics_of(ellipsoid), from, to);
}

double path_m(const Ellipsoid& ellipsoid, std::span<const Geodetic> places) {
  const GeographicLib::GeodesicExact geodesics = geodesics_of(ellipsoid);
  double total_m = 0.0;
  for (std::size_t k = 1; k < places.size(); ++k) total_m += distance_m(geodesics, places[k - 1], places[k]);
  return total_m;
}

std::vector<Geodetic> geodesic_places(const Ellipsoid& ellipsoid, const Geodetic& from, const Geodetic& to, int count) {
  count = std::max(count, 2);
  const auto line =
      geodesics_of(ellipsoid).InverseLine(latitude_deg(from), from.lon.deg(), latitude_deg(to), to.lon.deg());
  std::vector<Geodetic> places;
  for (int k = 0; k < count; ++k) {
    const double share = double(k) / (count - 1);
    double lat_deg = 0.0, lon_deg = 0.0;
    line.Position(share * line.Distance(), lat_deg, lon_deg);
    places.push_back({.lat = Angle::degrees(lat_deg),
                      .lon = Angle::degrees(lon_deg),
                      .height_m = (1.0 - share) * from.height_m + share * to.height_m});
  }
  return places;
}

PolygonMeasure polygon_measure(const Ellipsoid& ellipsoid, std::span<const Geodetic> ring) {
  const GeographicLib::GeodesicExact geodesics = geodesics_of(ellipsoid);
  GeographicLib::PolygonAreaExact polygon(geodesics);
  for (const Geodetic& place : ring) polygon.AddPoint(latitude_deg(place), place.lon.deg());
  PolygonMeasure measure;
  constexpr bool kClockwise = false, kSigned = true;
  polygon.Compute(kClockwise, kSigned, measure.perimeter_m, measure.area_m2);
  measure.area_m2 = ring.size() < 3 ? 0.0 : std::abs(measure.area_m2);
  return measure;
}

}  // namespace terrella
