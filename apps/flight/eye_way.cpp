#include "apps/flight/eye_way.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "apps/flight/monotone_curve.h"
#include "geo/ellipsoid.h"

namespace terrella {
namespace {

constexpr double kNoAngle_rad = 1e-12;    // 6 µm on the Earth: no direction
constexpr double kFastest = 2.0;          // speed at a place, over the slower of the speeds before and after it
constexpr double kStepOfCourse = 1.0e-4;  // part of a section over which the direction of motion is measured

/// A vector at `from` that points along the great circle to `to`, as long as the angle between them.
glm::dvec3 way_to(const glm::dvec3& from, const glm::dvec3& to) {
  const double angle = angle_between(from, to).rad();
  if (angle < kNoAngle_rad) return glm::dvec3(0.0);
  glm::dvec3 along = to - glm::dot(from, to) * from;
  if (glm::length(along) < kNoAngle_rad) {  // opposite places
    along = glm::cross(from, std::abs(from.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0));
  }
  return angle * glm::normalize(along);
}

/// The place that `way`, a vector at `from`, leads to.
glm::dvec3 follow(const glm::dvec3& from, const glm::dvec3& way) {
  const double angle = glm::length(way);
  if (angle < kNoAngle_rad) return from;
  return glm::normalize(std::cos(angle) * from + (std::sin(angle) / angle) * way);
}

glm::dvec3 between(const glm::dvec3& a, const glm::dvec3& b, double u) { return follow(a, u * way_to(a, b)); }

/// Velocity at a place, radians a second, between the mean velocities of the sections before and after it.
glm::dvec3 velocity(const glm::dvec3& before, double before_s, const glm::dvec3& after, double after_s) {
  const glm::dvec3 mean = (after_s * before + before_s * after) / (before_s + after_s);
  const double most = kFastest * std::min(glm::length(before), glm::length(after));
  const double speed = glm::length(mean);
  return speed > most ? (most / speed) * mean : mean;
}

}  // namespace

Angle angle_between(const glm::dvec3& a, const glm::dvec3& b) {
  return Angle::radians(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

EyeWay::EyeWay(const std::vector<double>& times, const std::vector<glm::dvec3>& normals)
    : times_(times), first_(normals.front()) {
  const std::size_t last = times_.size() - 1;
  const auto length = [this](std::size_t i) { return times_[i + 1] - times_[i]; };
  const auto mean = [&](std::size_t from, std::size_t to) {
    return way_to(normals[from], normals[to]) / length(std::min(from, to));
  };
  sections_.reserve(last);
  glm::dvec3 start = last > 0 ? mean(0, 1) : glm::dvec3(0.0);
  for (std::size_t i = 0; i < last; ++i) {
    const glm::dvec3 arrival = -mean(i + 1, i);
    const glm::dvec3 end = i + 1 < last ? velocity(arrival, length(i), mean(i + 1, i + 2), length(i + 1)) : arrival;
    const double third_s = length(i) / 3.0;
    sections_.push_back(
        {{normals[i], follow(normals[i], third_s * start), follow(normals[i + 1], -third_s * end), normals[i + 1]}});
    start = end;
  }
}

// De Casteljau's construction, with great circles for straight lines.
glm::dvec3 EyeWay::within(double time, std::size_t section) const {
  const double u = std::clamp((time - times_[section]) / (times_[section + 1] - times_[section]), 0.0, 1.0);
  const auto& p = sections_[section].points;
  const glm::dvec3 ab = between(p[0], p[1], u), bc = between(p[1], p[2], u), cd = between(p[2], p[3], u);
  return between(between(ab, bc, u), between(bc, cd, u), u);
}

glm::dvec3 EyeWay::at(double time) const { return sections_.empty() ? first_ : within(time, section_at(times_, time)); }

double EyeWay::course_deg(double time, std::size_t section) const {
  const double step_s = kStepOfCourse * (times_[section + 1] - times_[section]);
  const double middle_s = std::clamp(time, times_[section] + step_s, times_[section + 1] - step_s);
  const glm::dvec3 motion = within(middle_s + step_s, section) - within(middle_s - step_s, section);
  const Geodetic at = Ellipsoid::lat_lon(EcefDir{within(time, section)});
  const double sin_lat = std::sin(at.lat.rad()), cos_lat = std::cos(at.lat.rad());
  const double sin_lon = std::sin(at.lon.rad()), cos_lon = std::cos(at.lon.rad());
  const double east = cos_lon * motion.y - sin_lon * motion.x;
  const double north = cos_lat * motion.z - sin_lat * (cos_lon * motion.x + sin_lon * motion.y);
  return Angle::radians(std::atan2(east, north)).deg();
}

}  // namespace terrella
