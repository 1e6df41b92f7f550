#include "view/orbit.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "view/ground_frame.h"

namespace terrella {
namespace {

// sine of the angle to the vertical below which a line of sight has no usable azimuth (0.6 m on Earth)
constexpr double kVertical = 1e-7;

/// Returns the azimuth of a direction at a place. `fallback` gives the azimuth if the direction is vertical.
double azimuth_rad(const glm::dvec3& direction, const EastNorth& axes, const glm::dvec3& fallback) {
  const glm::dvec2 flat(glm::dot(direction, axes.north), glm::dot(direction, axes.east));
  if (glm::length(flat) > kVertical) return std::atan2(flat.y, flat.x);
  return std::atan2(glm::dot(fallback, axes.east), glm::dot(fallback, axes.north));
}

}  // namespace

Orbit orbit_around(const Camera& camera, const Ellipsoid& ellipsoid, const Ecef& pivot) {
  const View view = make_view(camera, ellipsoid, Viewport{});
  const glm::dvec3 normal = ellipsoid.surface_normal(pivot).xyz;
  const double sine = std::clamp(-glm::dot(view.forward, normal), -1.0, 1.0);
  const double azimuth = azimuth_rad(view.forward, east_north(normal), ground_frame(camera).ahead);
  return {pivot, Angle::radians(azimuth), Angle::radians(std::asin(sine)), glm::distance(pivot.xyz_m, view.eye.xyz_m)};
}

Camera orbit_camera(const Orbit& orbit, const Ellipsoid& ellipsoid, Angle fov_y) {
  const glm::dvec3 normal = ellipsoid.surface_normal(orbit.pivot).xyz;
  const EastNorth there = east_north(normal);
  const glm::dvec3 flat = there.north * std::cos(orbit.azimuth.rad()) + there.east * std::sin(orbit.azimuth.rad());
  const glm::dvec3 forward = flat * std::cos(orbit.depression.rad()) - normal * std::sin(orbit.depression.rad());
  Camera camera;
  camera.fov_y = fov_y;
  camera.eye = ellipsoid.to_geodetic(Ecef{orbit.pivot.xyz_m - forward * orbit.distance_m});
  const glm::dvec3 up = Ellipsoid::normal(camera.eye.lat, camera.eye.lon).xyz;
  // Looking straight down, the top of the picture is the heading, which is the limit of the azimuth.
  camera.heading = Angle::radians(azimuth_rad(forward, east_north(up), flat));
  camera.pitch = Angle::radians(std::atan2(glm::dot(forward, up), glm::length(forward - up * glm::dot(forward, up))));
  return camera;
}

}  // namespace terrella
