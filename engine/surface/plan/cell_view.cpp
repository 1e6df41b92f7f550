#include "surface/plan/cell_view.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "geo/scaled_space.h"

namespace terrella {
namespace {
constexpr unsigned kHorizon = 16U;
}

CellView::CellView(const View& view, const Ellipsoid& ellipsoid, bool has_relief)
    : eye_m_(view.eye.xyz_m), eye_spread_m_(view.eye_spread_m), planes_(view_planes(view)) {
  const glm::dvec3 eye_scaled = view.eye.xyz_m / semi_axes_m(ellipsoid);
  has_horizon_ = glm::dot(eye_scaled, eye_scaled) > 1.0 && !has_relief;
  eye_over_axes2_ = eye_scaled / semi_axes_m(ellipsoid);
  // The shortest axis overestimates the reach, so that everything in sight counts as seen.
  horizon_per_m_ = glm::length(eye_scaled) / ellipsoid.b_m();
  horizon_ = 1.0 - view.eye_spread_m / ellipsoid.b_m();
  least_radius_per_m_ = 2.0 / ellipsoid.b_m();
}

CellView::Beyond CellView::beyond(const BoundingSphere& sphere) const {
  Beyond result;
  const auto compare = [&](unsigned limit, double place, double least, double reach) {
    if (place >= least + reach) return;
    result.some |= limit;
    if (place < least) result.middle |= limit;
    if (place < least - reach) result.all |= limit;
  };
  const glm::dvec3 from_eye = sphere.center_m - eye_m_;
  for (std::size_t k = 0; k < planes_.normals.size(); ++k) {
    compare(1U << k, glm::dot(planes_.normals[k], from_eye), -eye_spread_m_, sphere.radius_m);
  }
  if (has_horizon_) {
    compare(kHorizon, glm::dot(sphere.center_m, eye_over_axes2_), horizon_, sphere.radius_m * horizon_per_m_);
  }
  return result;
}

// Those of the limits that everything within reach of the point lies beyond.
unsigned CellView::all_beyond(const glm::dvec3& p_m, double reach_m, unsigned limits) const {
  unsigned sides = 0;
  const glm::dvec3 from_eye = p_m - eye_m_;
  for (std::size_t k = 0; k < planes_.normals.size(); ++k) {
    if ((limits & 1U << k) != 0 && glm::dot(planes_.normals[k], from_eye) < -reach_m - eye_spread_m_) sides |= 1U << k;
  }
  if ((limits & kHorizon) != 0 && glm::dot(p_m, eye_over_axes2_) < horizon_ - reach_m * horizon_per_m_)
    sides |= kHorizon;
  return sides;
}

bool CellView::sees(const SelectedPatch& patch, const TileWindow& window, int x, int y, TreeGrowth& growth) const {
  if (!patch.cut_by_view) return true;
  const CellExtent& cell = window.cell(x, y);
  const PatchRelief& relief = patch.body().relief;
  const Beyond limits =
      beyond({cell.whole.center_m + relief.middle_m * cell.up,
              cell.whole.radius_m * (1.0 + std::abs(relief.middle_m) * least_radius_per_m_) + relief.half_m});
  if (limits.middle == 0) return true;
  if (limits.all != 0) return false;
  const SurfaceLattice& lattice = growth.lattice(*patch.node, window, x, y);
  return sees_part(lattice, std::abs(relief.middle_m) + relief.half_m, limits.some);
}

// A quad is out of view if one limit has all its corners beyond it.
bool CellView::sees_part(const SurfaceLattice& lattice, double relief_m, unsigned limits) const {
  constexpr int kSide = kLatticeQuads + 1;
  std::array<unsigned, static_cast<std::size_t>(kSide * kSide)> sides{};
  for (std::size_t k = 0; k < sides.size(); ++k) {
    sides[k] = all_beyond(lattice.points_m[k], lattice.bulge_m + relief_m, limits);
    if (sides[k] == 0) return true;
    const bool ends_a_quad = k > kSide && k % kSide != 0;
    if (ends_a_quad && (sides[k] & sides[k - 1] & sides[k - kSide] & sides[k - kSide - 1]) == 0) return true;
  }
  return false;
}

}  // namespace terrella
