#include "apps/flight/tour_flight.h"

#include <algorithm>
#include <span>

#include "geo/body.h"
#include "view/orbit.h"

namespace terrella {
namespace {

constexpr double kStraightDown_deg = -90.0;
constexpr double kLeastRange_m = 0.1;

Camera camera_of(const KmlView& view) {
  Camera camera;
  camera.eye = {.lat = Angle::degrees(view.lat_deg), .lon = Angle::degrees(view.lon_deg), .height_m = view.height_m};
  camera.heading = Angle::degrees(view.heading_deg);
  camera.pitch = Angle::degrees(std::min(kStraightDown_deg + view.tilt_deg, 90.0));
  if (!view.range_m) return camera;
  const Ellipsoid& ellipsoid = earth().ellipsoid;
  const Orbit orbit{.pivot = ellipsoid.to_ecef(camera.eye),
                    .azimuth = camera.heading,
                    .depression = Angle::degrees(-camera.pitch.deg()),
                    .distance_m = std::max(*view.range_m, kLeastRange_m)};
  return orbit_camera(orbit, ellipsoid, camera.fov_y);
}

FlightPath flight_of(std::span<const TourView> views) {
  const bool timed = std::ranges::all_of(views, [](const TourView& at) { return at.view.instant.has_value(); });
  std::vector<double> times;
  std::vector<FlightMoment> keyframes;
  times.reserve(views.size());
  keyframes.reserve(views.size());
  for (const TourView& at : views) {
    times.push_back(at.time_s - views.front().time_s);
    keyframes.push_back({.camera = camera_of(at.view), .sun = timed ? at.view.instant : std::nullopt});
  }
  return {std::move(times), keyframes};
}

}  // namespace

std::vector<FlightPath> flights_of(const std::vector<KmlTour>& tours) {
  std::vector<FlightPath> flights;
  for (const KmlTour& tour : tours) {
    const std::span<const TourView> views = tour.views;
    for (std::size_t first = 0, end = 1; end <= views.size(); ++end) {
      if (end < views.size() && !views[end].jumps) continue;
      flights.push_back(flight_of(views.subspan(first, end - first)));
      first = end;
    }
  }
  return flights;
}

}  // namespace terrella
