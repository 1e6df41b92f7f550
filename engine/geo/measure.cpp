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

std::vector<Geodetic> ring_around_way(const Ellipsoid& ellipsoid, const Geodetic& from, const Geodetic& to,
                                      double radius_m) {
  constexpr int kArcs = 24;                // pieces of half a circle; their chords stay beyond the radius
  constexpr double kStepsARadius = 320.0;  // the ring's sides are no geodesics
  const GeographicLib::GeodesicExact geodesics = geodesics_of(ellipsoid);
  const auto line = geodesics.InverseLine(latitude_deg(from), from.lon.deg(), latitude_deg(to), to.lon.deg());
  const double away_m = radius_m / std::cos(Angle::degrees(90.0 / kArcs).rad());
  const int steps = static_cast<int>(std::ceil(line.Distance() / ellipsoid.a_m() * kStepsARadius));
  std::vector<Geodetic> ring;
  ring.reserve(2 * (static_cast<std::size_t>(steps) + kArcs + 1));
  const auto add = [&](double along_m, double turn_deg) {
    double lat_deg = 0.0, lon_deg = 0.0, azimuth_deg = 0.0;
    line.Position(along_m, lat_deg, lon_deg, azimuth_deg);
    geodesics.Direct(lat_deg, lon_deg, azimuth_deg + turn_deg, away_m, lat_deg, lon_deg);
    ring.push_back({.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg)});
  };
  for (const bool back : {false, true}) {
    for (int k = 0; k < steps; ++k) {
      const double share = double(back ? steps - k : k) / steps;
      add(share * line.Distance(), back ? 90.0 : -90.0);
    }
    for (int k = 0; k < kArcs; ++k) add(back ? 0.0 : line.Distance(), (back ? 90.0 : -90.0) + 180.0 * k / kArcs);
  }
  return ring;
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
