#include "scene/limb.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

namespace terrella {
namespace {

// A limb of radius r on the screen, drawn with N segments, sags r (π/N)²/2; the horizon of an eye near the ground is a
// hyperbola of which little is seen, and takes the most.
constexpr double kSagitta_px = 0.02;
constexpr int kFewestSegments = 48, kMostSegments = 4096;

int segments_for(const View& view, double eye_scaled_length) {
  const double sine = 1.0 / eye_scaled_length;
  // The disc's radius on the screen, larger by the stretch of a perspective picture's corner.
  const double corner = 1.0 + view.tan_half_fov_y * view.tan_half_fov_y * (1.0 + view.aspect() * view.aspect());
  const double radius_px = corner * view.pixels_per_radian() * sine / std::sqrt(std::max(1e-12, 1.0 - sine * sine));
  const double n = std::numbers::pi * std::sqrt(radius_px / (2.0 * kSagitta_px));
  return static_cast<int>(std::clamp(n, double(kFewestSegments), double(kMostSegments)));
}

class LimbCurve {
 public:
  LimbCurve(const View& view, const Ellipsoid& ellipsoid)
      : view_(view), axes_m_(ellipsoid.a_m(), ellipsoid.a_m(), ellipsoid.b_m()) {
    const glm::dvec3 eye = view.eye.xyz_m / axes_m_;
    const double length = glm::length(eye);
    seen_from_outside_ = length > 1.0 && std::isfinite(length);
    if (!seen_from_outside_) return;
    segments_ = segments_for(view, length);
    const glm::dvec3 axis = eye / length;
    center_ = axis / length;
    const double radius = std::sqrt(std::max(0.0, (length - 1.0) * (length + 1.0))) / length;
    const glm::dvec3 other = std::abs(axis.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    u_ = radius * glm::normalize(glm::cross(axis, other));
    v_ = radius * glm::normalize(glm::cross(axis, u_));
  }

  [[nodiscard]] int segments() const { return segments_; }
  [[nodiscard]] bool seen_from_outside() const { return seen_from_outside_; }

  // Pixels from the picture's centre, +y up; nothing behind the eye.
  [[nodiscard]] std::optional<glm::dvec2> pixel(int k) const {
    const double t = 2.0 * std::numbers::pi * k / segments_;
    const glm::dvec3 p = (center_ + std::cos(t) * u_ + std::sin(t) * v_) * axes_m_ - view_.eye.xyz_m;
    const double depth = glm::dot(p, view_.forward);
    if (depth <= 1e-9 * glm::length(p)) return std::nullopt;
    return glm::dvec2(glm::dot(p, view_.right), glm::dot(p, view_.up)) * (view_.pixels_per_radian() / depth);
  }

 private:
  const View& view_;
  glm::dvec3 axes_m_;
  glm::dvec3 center_{0.0}, u_{0.0}, v_{0.0};
  bool seen_from_outside_ = false;
  int segments_ = 0;
};

bool far_outside(glm::dvec2 p, const View& view) {
  // Generous: a segment whose two ends are further out than this may be left out.
  return std::abs(p.x) > 2.0 * view.viewport.width_px + 64.0 || std::abs(p.y) > 2.0 * view.viewport.height_px + 64.0;
}

}  // namespace

std::vector<LimbVertex> limb_ribbon(const View& view, const Ellipsoid& ellipsoid, double half_width_px) {
  std::vector<LimbVertex> strip;
  const LimbCurve curve(view, ellipsoid);
  if (!curve.seen_from_outside()) return strip;
  // The planet's centre tells which side of the curve is inside, also where the limb is cut by the picture's edge.
  const glm::dvec3 down = -glm::normalize(view.eye.xyz_m);
  const glm::dvec2 half(0.5 * view.viewport.width_px, 0.5 * view.viewport.height_px);
  std::optional<glm::dvec2> a = curve.pixel(0);
  for (int k = 1; k <= curve.segments(); ++k) {
    const std::optional<glm::dvec2> b = curve.pixel(k);
    const bool draw = a && b && !(far_outside(*a, view) && far_outside(*b, view)) && glm::distance(*a, *b) > 1e-9;
    if (draw) {
      const glm::dvec2 along = glm::normalize(*b - *a);
      // Seen from outside the curve runs one way round the disc; which, shows the side of the nadir's direction.
      glm::dvec2 out(along.y, -along.x);
      const glm::dvec3 ray = view.forward * view.pixels_per_radian() + view.right * a->x + view.up * a->y;
      const glm::dvec3 tilt = view.right * out.x + view.up * out.y;
      if (glm::dot(tilt - ray * (glm::dot(tilt, ray) / glm::dot(ray, ray)), down) > 0.0) out = -out;
      const LimbVertex corner[4] = {
          {glm::vec2((*a - out * half_width_px) / half), glm::vec2(out), static_cast<float>(-half_width_px)},
          {glm::vec2((*a + out * half_width_px) / half), glm::vec2(out), static_cast<float>(half_width_px)},
          {glm::vec2((*b - out * half_width_px) / half), glm::vec2(out), static_cast<float>(-half_width_px)},
          {glm::vec2((*b + out * half_width_px) / half), glm::vec2(out), static_cast<float>(half_width_px)}};
      if (!strip.empty()) strip.push_back(strip.back());
      if (!strip.empty()) strip.push_back(corner[0]);
      strip.insert(strip.end(), std::begin(corner), std::end(corner));
    }
    a = b;
  }
  return strip;
}

}  // namespace terrella
