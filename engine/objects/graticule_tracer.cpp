#include "objects/graticule_tracer.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "view/surface_pin.h"

namespace terrella {
namespace {

constexpr int kHalvings = 20;               // bisections of a chord that the horizon cuts
constexpr double kFlatteningMargin = 0.02;  // radians that the horizon may lie farther than on a sphere
constexpr double kBeyond = 0.25;            // lines continue past the picture's edges by this fraction of its size
constexpr int kStrengths = 8;               // steps of opacity; finer ones cannot be told apart
// Ground seen at a grazing angle counts as if it were seen at least this steeply, so that lines reach the horizon.
constexpr double kLeastSteepness = 0.2;

float in_steps(double strength) { return static_cast<float>(std::ceil(strength * kStrengths) / kStrengths); }

}  // namespace

GraticuleTracer::GraticuleTracer(const View& view, const Ellipsoid& ellipsoid) : view_(view), ellipsoid_(ellipsoid) {}

double GraticuleTracer::pixels_per_degree(double distance_m) const {
  return view_.pixels_per_radian() / std::max(distance_m, 0.1) * ellipsoid_.a_m() * Angle::degrees(1.0).rad();
}

double GraticuleTracer::reach_deg(double least_px) const {
  const double height_m = std::max(ellipsoid_.to_geodetic(view_.eye).height_m, 1.0);
  const double eye = std::max(glm::length(view_.eye.xyz_m), ellipsoid_.b_m()), ground = eye - height_m;
  const double distance_m = pixels_per_degree(1.0) / least_px;
  const double horizon = std::acos(ground / eye) + kFlatteningMargin;
  const double cosine = (eye * eye + ground * ground - distance_m * distance_m) / (2.0 * eye * ground);
  return Angle::radians(std::min(horizon, std::acos(std::clamp(cosine, -1.0, 1.0)))).deg();
}

std::vector<TracedPiece> GraticuleTracer::trace(const Curve& curve, const TracedSpacing& spacing, double from,
                                                double to, double step) const {
  std::vector<TracedPiece> pieces;
  const auto add = [&pieces](const Spot& a, const Spot& b) {
    const float strength = in_steps(std::max(a.strength, b.strength));
    if (pieces.empty() || pieces.back().strength != strength || pieces.back().points_px.back() != a.px) {
      pieces.push_back({{a.px}, strength});
    }
    pieces.back().points_px.push_back(b.px);
  };
  const int count = std::max(1, static_cast<int>(std::ceil((to - from) / step)));
  std::optional<Spot> last;
  for (int i = 0; i <= count; ++i) {
    const double at = from + (to - from) * i / count;
    const double before = from + (to - from) * (i - 1) / count;
    const std::optional<Spot> now = spot(curve(at), spacing);
    if (now && last) add(*last, *now);
    if (now && !last && i > 0) add(edge(curve, spacing, at, before), *now);
    if (!now && last) add(*last, edge(curve, spacing, before, at));
    last = now;
  }
  return pieces;
}

/// Position of a place in the picture; nothing behind the horizon, far outside, or where lines are too near together.
std::optional<GraticuleTracer::Spot> GraticuleTracer::spot(const Geodetic& place, const TracedSpacing& spacing) const {
  const EcefDir normal = Ellipsoid::normal(place.lat, place.lon);
  const Ecef p = ellipsoid_.position(normal);
  const glm::dvec3 to_eye = view_.eye.xyz_m - p.xyz_m;
  const double rise_m = glm::dot(to_eye, normal.xyz);
  if (rise_m <= 0.0) return {};
  const double distance_m = glm::length(to_eye);
  const double steepness = std::max(kLeastSteepness, std::sqrt(rise_m / distance_m));
  const double narrowing = spacing.narrows ? std::cos(place.lat.rad()) : 1.0;
  const double gap_px = spacing.spacing_deg * narrowing * steepness * pixels_per_degree(distance_m);
  const double strength = glm::smoothstep(spacing.faint_px, spacing.full_px, gap_px);
  if (strength <= 0.0) return {};
  const auto px = project(view_, p);
  if (!px) return {};
  const glm::dvec2 part = *px / glm::dvec2(view_.viewport.width_px, view_.viewport.height_px);
  const bool near = part.x > -kBeyond && part.x < 1.0 + kBeyond && part.y > -kBeyond && part.y < 1.0 + kBeyond;
  if (!near) return {};
  return Spot{*px, strength};
}

/// The last visible point between a visible and a hidden one.
GraticuleTracer::Spot GraticuleTracer::edge(const Curve& curve, const TracedSpacing& spacing, double seen,
                                            double unseen) const {
  Spot best = *spot(curve(seen), spacing);
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (seen + unseen);
    const auto found = spot(curve(middle), spacing);
    (found ? seen : unseen) = middle;
    if (found) best = *found;
  }
  return best;
}

}  // namespace terrella
