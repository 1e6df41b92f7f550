#include "surface/far_side_curtain.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace terrella {
namespace {

// Chords round the planet sag by 1/3300 of its radius, 2 km on Earth; chords across by a tenth of that.
constexpr int kColumns = 128;
constexpr int kRings = 12;
constexpr double kEarthEquator_m = 6378137.0;

/// Scaled space, where the ellipsoid is the unit sphere: the eye's distance and three axes, the first to the eye.
struct EyeAxes {
  double distance;
  glm::dvec3 to_eye, u, v;
};

EyeAxes eye_axes(const glm::dvec3& eye) {
  const double distance = glm::length(eye);
  const glm::dvec3 to_eye = eye / distance;
  const glm::dvec3 other = std::abs(to_eye.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(other, to_eye));
  return {distance, to_eye, u, glm::cross(to_eye, u)};
}

// A sphere's limb is the circle whose places stand at right angles to their lines of sight.
glm::dvec3 limb_place(const EyeAxes& axes, double radius, double turn) {
  const double cosine = radius / axes.distance, sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
  return radius * (cosine * axes.to_eye + sine * (std::cos(turn) * axes.u + std::sin(turn) * axes.v));
}

}  // namespace

std::vector<glm::vec3> far_side_curtain(const View& view, const Ellipsoid& ellipsoid, double inner_radius_m,
                                        double lowest_m) {
  const double a_m = ellipsoid.a_m();
  const glm::dvec3 axes_m(a_m, a_m, ellipsoid.b_m());
  const EyeAxes axes = eye_axes(view.eye.xyz_m / axes_m);
  const double limb_m = a_m * std::sqrt(std::max(0.0, axes.distance * axes.distance - 1.0));
  const double pixel_m = limb_m / view.pixels_per_radian();
  // Down by the part of the shorter axis: the longer one goes down by more.
  const double outer = 1.0 + (lowest_m - pixel_m) / ellipsoid.b_m(), inner = inner_radius_m / a_m;
  if (!(outer < axes.distance) || !(inner < outer) || !(inner > 0.0)) return {};
  const double first = std::acos(inner / axes.distance), last = std::acos(outer / axes.distance);
  std::vector<glm::vec3> strip;
  strip.reserve(static_cast<std::size_t>(kRings) * 2 * (kColumns + 2));
  const auto place = [&](int ring, int column) {
    const double radius = axes.distance * std::cos(first + (last - first) * ring / kRings);
    const glm::dvec3 scaled = limb_place(axes, radius, 2.0 * std::numbers::pi * column / kColumns);
    return glm::vec3(scaled * axes_m - view.eye.xyz_m);
  };
  for (int ring = 0; ring < kRings; ++ring) {
    if (ring > 0) strip.push_back(strip.back());
    if (ring > 0) strip.push_back(place(ring, 0));
    for (int column = 0; column <= kColumns; ++column) {
      strip.push_back(place(ring, column));
      strip.push_back(place(ring + 1, column));
    }
  }
  return strip;
}

double inner_sphere_radius_m(double a_m, double b_m, double below_m) {
  return std::clamp(a_m - below_m * (a_m / kEarthEquator_m), 0.0, 0.98 * b_m);
}

}  // namespace terrella
