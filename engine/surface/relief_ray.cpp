#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "surface/relief.h"

namespace terrella {
namespace {

// Length of a step along the ray, as a share of the spacing of heights: it misses none.
constexpr double kStepShare = 0.5;
// More than the longest way through a mountainous shell has in the finest steps. Beyond it ground is under a pixel.
constexpr int kMostSteps = 200000;
constexpr double kClosest_m = 1e-4;
constexpr double kClosestShare = 1e-12;

struct Interval {
  double from_m, to_m;
};

/// The part of a ray, from its origin on, in which it is within an ellipsoid of other axes but the same centre.
std::optional<Interval> within(const Ellipsoid& body, double over_m, const Ecef& origin, const EcefDir& direction) {
  const double a_m = body.a_m() + over_m, b_m = body.b_m() + over_m;
  if (!(a_m > 0.0) || !(b_m > 0.0)) return std::nullopt;
  const glm::dvec3 scale(1.0 / a_m, 1.0 / a_m, 1.0 / b_m);
  const glm::dvec3 o = origin.xyz_m * scale, d = direction.xyz * scale;
  const double dd = glm::dot(d, d), nearest = -glm::dot(o, d) / dd;
  const glm::dvec3 p = o + nearest * d;
  const double room = 1.0 - glm::dot(p, p);
  if (!(room > 0.0)) return std::nullopt;
  const double half = std::sqrt(room / dd);
  if (nearest + half <= 0.0) return std::nullopt;
  return Interval{std::max(0.0, nearest - half), nearest + half};
}

/// Follows a ray until it goes through the ground.
class GroundMarch {
 public:
  GroundMarch(const Ellipsoid& ellipsoid, const HeightField& field, double exaggeration, const Ecef& origin,
              const EcefDir& direction, double radians_per_px)
      : ellipsoid_(ellipsoid),
        field_(field),
        exaggeration_(exaggeration),
        origin_(origin),
        direction_(direction),
        radians_per_step_(std::max(radians_per_px, 1e-9) / std::max(1.0, exaggeration_)),
        under_(over_m(0.0) < 0.0) {}

  [[nodiscard]] std::optional<double> follow(Interval part) {
    if (!(part.to_m > part.from_m)) return std::nullopt;
    double last_m = part.from_m;
    if ((over_m(last_m) < 0.0) != under_) return last_m;
    for (int k = 0; k < kMostSteps && last_m < part.to_m; ++k) {
      const double next_m = std::min(last_m + step_m(last_m), part.to_m);
      if ((over_m(next_m) < 0.0) != under_) return halved(last_m, next_m);
      last_m = next_m;
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] double over_m(double at_m) {
    const Geodetic at = ellipsoid_.to_geodetic(Ecef{origin_.xyz_m + at_m * direction_.xyz});
    return at.height_m - exaggeration_ * field_.height_at_row_m(field_.row_deg(at.lat), at.lon.deg());
  }

  [[nodiscard]] double step_m(double at_m) const {
    return std::max({kStepShare * field_.spacing_m(), radians_per_step_ * at_m, 10.0 * kClosest_m});
  }

  [[nodiscard]] double halved(double before_m, double behind_m) {
    while (behind_m - before_m > std::max(kClosest_m, kClosestShare * behind_m)) {
      const double middle_m = 0.5 * (before_m + behind_m);
      if (middle_m <= before_m || middle_m >= behind_m) break;
      ((over_m(middle_m) < 0.0) == under_ ? before_m : behind_m) = middle_m;
    }
    return 0.5 * (before_m + behind_m);
  }

  Ellipsoid ellipsoid_;
  HeightField::Cursor field_;
  double exaggeration_;
  Ecef origin_;
  EcefDir direction_;
  double radians_per_step_;
  bool under_;
};

}  // namespace

std::optional<double> Relief::intersect_m(const Ecef& origin, const EcefDir& direction, double radians_per_px) const {
  const glm::dvec3 all = origin.xyz_m + direction.xyz;
  if (!std::isfinite(all.x + all.y + all.z)) return std::nullopt;
  // Points of one height lie no further out than an ellipsoid of longer axes reaches, but for a part f² of the height.
  const double f = ellipsoid_.f();
  const GroundRange range = range_m();
  const auto shell = within(ellipsoid_, range.max_m * (1.0 + f * f) + 1.0, origin, direction);
  if (!shell) return std::nullopt;
  GroundMarch march(ellipsoid_, field_, exaggeration_, origin, direction, radians_per_px);
  const auto core = within(ellipsoid_, range.min_m * (1.0 + f * f) - 1.0, origin, direction);
  if (!core) return march.follow(*shell);
  if (const auto before = march.follow({shell->from_m, core->from_m})) return before;
  return march.follow({core->to_m, shell->to_m});
}

}  // namespace terrella
