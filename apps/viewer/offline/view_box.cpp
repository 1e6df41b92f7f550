#include "apps/viewer/offline/view_box.h"

#include <algorithm>
#include <cmath>

namespace terrella {
namespace {

constexpr int kViewSamples = 24;      // places along each side of the picture
constexpr double kViewMargin = 0.03;  // part of the box, on each side

/// Box with longitudes continued over ±180°, and all of them if it reaches a pole.
GeoRect box_on_planet(double west, double south, double east, double north) {
  const bool round = south <= -90.0 || north >= 90.0 || east - west >= 360.0;
  return {.west = Angle::degrees(round ? -180.0 : std::remainder(west, 360.0)),
          .south = Angle::degrees(std::max(south, -90.0)),
          .east = Angle::degrees(round ? 180.0 : std::remainder(east, 360.0)),
          .north = Angle::degrees(std::min(north, 90.0))};
}

/// Everything within the horizon, on the sphere inside the ellipsoid.
GeoRect box_in_horizon(const Geodetic& eye, const Ellipsoid& ellipsoid) {
  const double radius = std::acos(ellipsoid.b_m() / (ellipsoid.a_m() + std::max(eye.height_m, 0.0)));
  const double radius_deg = Angle::radians(radius).deg(), lat = eye.lat.deg(), lon = eye.lon.deg();
  const double reach = std::sin(radius) / std::cos(eye.lat.rad());
  const double side_deg = std::abs(lat) + radius_deg >= 90.0 ? 180.0 : Angle::radians(std::asin(reach)).deg();
  return box_on_planet(lon - side_deg, lat - radius_deg, lon + side_deg, lat + radius_deg);
}

bool shows_pole(const View& view, const Ellipsoid& ellipsoid, double lat_deg) {
  const auto at = project(view, ellipsoid.to_ecef({.lat = Angle::degrees(lat_deg), .lon = {}}));
  if (!at || at->x < 0.0 || at->y < 0.0 || at->x > view.viewport.width_px || at->y > view.viewport.height_px)
    return false;
  const auto seen = pick(view, ellipsoid, *at);
  return seen && std::abs(seen->lat.deg() - lat_deg) < 1.0;  // not on the far side
}

}  // namespace

std::optional<GeoRect> view_box(const Camera& camera, const Ellipsoid& ellipsoid, Viewport viewport) {
  const View view = make_view(camera, ellipsoid, viewport);
  std::optional<double> first_lon;
  double west = 1e9, south = 90.0, east = -1e9, north = -90.0;
  bool horizon = false;
  for (int row = 0; row <= kViewSamples; ++row) {
    for (int column = 0; column <= kViewSamples; ++column) {
      const auto place =
          pick(view, ellipsoid,
               {double(viewport.width_px) * column / kViewSamples, double(viewport.height_px) * row / kViewSamples});
      horizon = horizon || !place;
      if (!place) continue;
      if (!first_lon) first_lon = place->lon.deg();
      const double lon = *first_lon + std::remainder(place->lon.deg() - *first_lon, 360.0);
      west = std::min(west, lon);
      east = std::max(east, lon);
      south = std::min(south, place->lat.deg());
      north = std::max(north, place->lat.deg());
    }
  }
  if (!first_lon) return std::nullopt;
  if (horizon) return box_in_horizon(camera.eye, ellipsoid);
  if (shows_pole(view, ellipsoid, 90.0)) north = 90.0;
  if (shows_pole(view, ellipsoid, -90.0)) south = -90.0;
  const double more_lon = kViewMargin * (east - west), more_lat = kViewMargin * (north - south);
  return box_on_planet(west - more_lon, south - more_lat, east + more_lon, north + more_lat);
}

}  // namespace terrella
