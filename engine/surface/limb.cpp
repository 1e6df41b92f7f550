#include "surface/limb.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

#include "geo/scaled_space.h"
#include "surface/view_planes.h"

namespace terrella {
namespace {

// Pieces of the curve that are looked at first; each is halved until it is straight or out of view.
constexpr int kPieces = 48;
// Less than the promised error: the rest is for the curve between the points that were looked at.
constexpr double kStraight_px = 0.015;
// A piece 2^-23 of the limb is a few pixels of the longest lens.
constexpr int kMostHalvings = 18;
// Around the picture: as much of the ribbon as may reach in.
constexpr int kMargin_px = 8;

class LimbCurve {
 public:
  LimbCurve(const View& view, const Ellipsoid& ellipsoid) : view_(view), axes_m_(semi_axes_m(ellipsoid)) {
    const glm::dvec3 eye = view.eye.xyz_m / axes_m_;
    const double length = glm::length(eye);
    const glm::dvec3 all = view.eye.xyz_m + view.right + view.up + view.forward;
    seen_from_outside_ = length > 1.0 && std::isfinite(all.x + all.y + all.z + view.tan_half_fov_y);
    const glm::dvec3 axis = eye / length;
    center_ = axis / length;
    const double radius = std::sqrt(std::max(0.0, (length - 1.0) * (length + 1.0))) / length;
    const glm::dvec3 other = std::abs(axis.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    u_ = radius * glm::normalize(glm::cross(axis, other));
    v_ = radius * glm::normalize(glm::cross(axis, u_));
  }

  [[nodiscard]] bool seen_from_outside() const { return seen_from_outside_; }

  // A point of the limb relative to the eye; t counts once round.
  [[nodiscard]] glm::dvec3 from_eye_m(double t) const {
    const double angle = 2.0 * std::numbers::pi * t;
    return (center_ + std::cos(angle) * u_ + std::sin(angle) * v_) * axes_m_ - view_.eye.xyz_m;
  }

  // Pixels from the picture's centre, +y up; nothing behind the eye.
  [[nodiscard]] std::optional<glm::dvec2> pixel(const glm::dvec3& p) const {
    const double depth = glm::dot(p, view_.forward);
    if (depth <= 1e-9 * glm::length(p)) return std::nullopt;
    return glm::dvec2(glm::dot(p, view_.right) - view_.shear_x * depth, glm::dot(p, view_.up)) *
           (view_.pixels_per_radian() / depth);
  }

 private:
  const View& view_;
  glm::dvec3 axes_m_;
  glm::dvec3 center_{0.0}, u_{0.0}, v_{0.0};
  bool seen_from_outside_ = false;
};

View with_margin(View view) {
  view.tan_half_fov_y *= 1.0 + 2.0 * kMargin_px / view.viewport.height_px;
  view.viewport.width_px += 2 * kMargin_px;
  view.viewport.height_px += 2 * kMargin_px;
  return view;
}

bool straight(glm::dvec2 a, glm::dvec2 mid, glm::dvec2 b) {
  const double length = glm::distance(a, b);
  if (length < kStraight_px) return glm::distance(a, mid) < kStraight_px;
  const glm::dvec2 along = (b - a) / length, d = mid - a;
  return std::abs(along.x * d.y - along.y * d.x) < kStraight_px;
}

class RibbonWriter {
 public:
  RibbonWriter(const View& view, const LimbCurve& curve, double half_width_px, std::vector<LimbVertex>& strip)
      : view_(view),
        curve_(curve),
        wide_(with_margin(view)),
        planes_(view_planes(wide_)),
        // The planet's centre tells which side of the curve is inside, also where the limb is cut by the picture's
        // edge.
        down_(-glm::normalize(view.eye.xyz_m)),
        half_width_px_(half_width_px),
        strip_(strip) {}

  void piece(double from, double to, int halvings) {
    const double middle = 0.5 * (from + to);
    const glm::dvec3 p = curve_.from_eye_m(from), mid = curve_.from_eye_m(middle), q = curve_.from_eye_m(to);
    // The arc bulges from its chord, never further from its middle than 1.1 times its ends are.
    const double radius_m = 1.1 * std::max(glm::distance(p, mid), glm::distance(q, mid));
    if (classify(planes_, wide_, {view_.eye.xyz_m + mid, radius_m}) < 0) return;
    const auto a = curve_.pixel(p), m = curve_.pixel(mid), b = curve_.pixel(q);
    if (halvings == 0 || (a && m && b && straight(*a, *m, *b))) {
      if (a && b && glm::distance(*a, *b) > 1e-9) segment(*a, *b);
      return;
    }
    piece(from, middle, halvings - 1);
    piece(middle, to, halvings - 1);
  }

  // Ends the strip where it began, if it goes all the way round.
  void close() {
    constexpr double kRounding_px = 1e-3;
    if (strip_.empty() || glm::distance(begin_, end_) > kRounding_px) return;
    const LimbVertex first[2] = {strip_[0], strip_[1]};
    strip_.insert(strip_.end(), std::begin(first), std::end(first));
  }

 private:
  void segment(glm::dvec2 a, glm::dvec2 b) {
    const glm::dvec2 half(0.5 * view_.viewport.width_px, 0.5 * view_.viewport.height_px);
    const glm::dvec2 along = glm::normalize(b - a);
    // Seen from outside the curve runs one way round the disc; which, shows the side of the nadir's direction.
    glm::dvec2 out(along.y, -along.x);
    const glm::dvec3 ray =
        (view_.forward + view_.shear_x * view_.right) * view_.pixels_per_radian() + view_.right * a.x + view_.up * a.y;
    const glm::dvec3 tilt = view_.right * out.x + view_.up * out.y;
    if (glm::dot(tilt - ray * (glm::dot(tilt, ray) / glm::dot(ray, ray)), down_) > 0.0) out = -out;
    const auto half_width = static_cast<float>(half_width_px_);
    const LimbVertex corner[4] = {{glm::vec2((a - out * half_width_px_) / half), glm::vec2(out), -half_width},
                                  {glm::vec2((a + out * half_width_px_) / half), glm::vec2(out), half_width},
                                  {glm::vec2((b - out * half_width_px_) / half), glm::vec2(out), -half_width},
                                  {glm::vec2((b + out * half_width_px_) / half), glm::vec2(out), half_width}};
    // Segments that meet share no corners. The strip goes on between them, so that it has no gap at a bend.
    if (!strip_.empty() && end_ != a) {
      strip_.push_back(strip_.back());
      strip_.push_back(corner[0]);
    }
    if (strip_.empty()) begin_ = a;
    end_ = b;
    strip_.insert(strip_.end(), std::begin(corner), std::end(corner));
  }

  const View& view_;
  const LimbCurve& curve_;
  View wide_;
  ViewPlanes planes_;
  glm::dvec3 down_;
  double half_width_px_;
  std::vector<LimbVertex>& strip_;
  glm::dvec2 begin_{0.0}, end_{0.0};  ///< start of the first segment, end of the last
};

}  // namespace

std::vector<LimbVertex> limb_ribbon(const View& view, const Ellipsoid& ellipsoid, double half_width_px) {
  std::vector<LimbVertex> strip;
  const LimbCurve curve(view, ellipsoid);
  if (!curve.seen_from_outside()) return strip;
  RibbonWriter writer(view, curve, half_width_px, strip);
  for (int k = 0; k < kPieces; ++k) writer.piece(double(k) / kPieces, double(k + 1) / kPieces, kMostHalvings);
  writer.close();
  return strip;
}

double LimbSquare::times_length_sq(glm::dvec2 px) const {
  const glm::dvec2 d = px - at_px;
  return there + glm::dot(slope, d) + bend.x * d.x * d.x + bend.y * d.x * d.y + bend.z * d.y * d.y;
}

// With the eye e and a ray r in scaled space, the square of the cosine is ((e r)² - (e² - 1) r²) / r².
std::optional<LimbSquare> limb_square(const View& view, const Ellipsoid& ellipsoid) {
  const glm::dvec3 axes_m = semi_axes_m(ellipsoid), eye = view.eye.xyz_m / axes_m, scale = ellipsoid.a_m() / axes_m;
  const double length = glm::length(eye), limb_sq = (length - 1.0) * (length + 1.0);
  if (!(length > 1.0)) return std::nullopt;
  const double pixel = 1.0 / view.pixels_per_radian();
  const glm::dvec3 x = scale * view.right * pixel, y = scale * view.up * pixel;
  const glm::dvec3 ahead = scale * (view.forward + view.shear_x * view.right);
  const auto product = [&](const glm::dvec3& a, const glm::dvec3& b) {
    return glm::dot(eye, a) * glm::dot(eye, b) - limb_sq * glm::dot(a, b);
  };
  LimbSquare square{.at_px = 0.5 * glm::dvec2(view.viewport.width_px, view.viewport.height_px),
                    .there = product(ahead, ahead),
                    .slope = 2.0 * glm::dvec2(product(ahead, x), product(ahead, y)),
                    .bend = {product(x, x), 2.0 * product(x, y), product(y, y)}};
  // Near a place on the limb floats are accurate: the next one up or down the slope from the picture's middle.
  const double steep = glm::length(square.slope);
  if (steep == 0.0) return square;
  const glm::dvec2 way = square.slope / steep;
  const double bend = square.bend.x * way.x * way.x + square.bend.y * way.x * way.y + square.bend.z * way.y * way.y;
  const double root_sq = steep * steep - 4.0 * bend * square.there;
  if (root_sq <= 0.0) return square;
  const glm::dvec2 to_limb = way * (-2.0 * square.there / (steep + std::sqrt(root_sq)));
  const glm::dvec3 there = ahead + to_limb.x * x + to_limb.y * y;
  square.at_px += to_limb;
  square.there = product(there, there);
  square.slope = 2.0 * glm::dvec2(product(there, x), product(there, y));
  return square;
}

LimbRing::LimbRing(const View& view, const Ellipsoid& ellipsoid) {
  const glm::dvec3 eye = view.eye.xyz_m / semi_axes_m(ellipsoid);
  const double length = glm::length(eye);
  if (!(length > 1.0)) return;
  towards_eye_ = eye / length;
  const double limb_rad = std::acos(1.0 / length), pixel = 2.0 * std::tan(limb_rad) / view.pixels_per_radian();
  const double reach_rad = std::sqrt(kLimb_px * pixel) + view.eye_spread_m / ellipsoid.b_m();
  const auto at = [](double angle_rad) { return glm::dvec2(std::cos(angle_rad), std::sin(angle_rad)); };
  begin_ = at(std::max(0.0, limb_rad - reach_rad));
  end_ = at(limb_rad + reach_rad);
}

bool LimbRing::meets(const glm::dvec3& axis, double cos_half_angle, double sin_half_angle) const {
  const double from_eye = glm::dot(axis, towards_eye_);
  const bool holds_begin = begin_.y * cos_half_angle < begin_.x * sin_half_angle;
  return from_eye > end_.x * cos_half_angle - end_.y * sin_half_angle &&
         (holds_begin || from_eye < begin_.x * cos_half_angle + begin_.y * sin_half_angle);
}

bool LimbRing::holds(const glm::vec3& point) const {
  const float from_eye = glm::dot(point, glm::vec3(towards_eye_));
  return from_eye < static_cast<float>(begin_.x) && from_eye > static_cast<float>(end_.x);
}

}  // namespace terrella
