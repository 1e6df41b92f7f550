#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "geo/angle.h"

// thread: any, for all of this header
namespace terrella {

/// Angle between two unit vectors.
[[nodiscard]] Angle angle_between(const glm::dvec3& a, const glm::dvec3& b);

/// The way of an eye over the globe, as unit normals at ascending times. Two places are joined by the great circle, at
/// constant speed. Through more places the way bends, so that its direction and speed have no jumps: each section is a
/// cubic Bézier curve made of great circles (Shoemake 1985, doi:10.1145/325334.325242). The eye stops at a place that
/// it stays at or turns back from. Between places on the opposite sides of the globe the way leads past an axis of the
/// coordinates.
class EyeWay {
 public:
  EyeWay() = default;
  /// As many times as normals, one at least.
  EyeWay(const std::vector<double>& times, const std::vector<glm::dvec3>& normals);
  [[nodiscard]] glm::dvec3 at(double time) const;
  /// Direction of motion at a time of a section, clockwise from north, (-180, 180]; 0 for an eye at rest.
  [[nodiscard]] double course_deg(double time, std::size_t section) const;

 private:
  struct Section {
    glm::dvec3 points[4];
  };
  [[nodiscard]] glm::dvec3 within(double time, std::size_t section) const;

  std::vector<double> times_;
  std::vector<Section> sections_;
  glm::dvec3 first_{0.0};
};

}  // namespace terrella
