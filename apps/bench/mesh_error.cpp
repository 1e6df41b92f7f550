#include "apps/bench/mesh_error.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "apps/bench/drawn_triangles.h"
#include "apps/bench/shots.h"
#include "apps/bench/truth/ray_caster.h"

namespace terrella::bench {
namespace {

constexpr double kClear_deg = 81.0;
constexpr double kDegree_rad = std::numbers::pi / 180.0;
constexpr double kMostSilhouette_px = 256.0;

glm::dvec3 direction_to(const glm::dvec2& lon_lat_deg) { return truth::local_frame(lon_lat_deg.y, lon_lat_deg.x).up; }

/// Interpolates a point of a triangle from its corners, as the rasteriser does.
DrawnVertex mixed(const DrawnTriangle& t, const glm::dvec3& weights) {
  DrawnVertex v{glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec2(0.0)};
  for (int k = 0; k < 3; ++k) {
    const auto& corner = t[static_cast<std::size_t>(k)];
    v.position_m += weights[k] * corner.position_m;
    v.direction += weights[k] * corner.direction;
    v.lon_lat_deg += weights[k] * corner.lon_lat_deg;
  }
  return v;
}

class Inspector {
 public:
  Inspector(const PatchTree& tree, const View& view, const Camera& camera)
      : view_(view),
        body_(as_spheroid(tree.ellipsoid())),
        grid_(tree.grid()),
        rays_(body_, as_truth_camera(camera), view.viewport.width_px, view.viewport.height_px) {}

  void look_at(const DrawnTriangle& triangle, bool exact, int tile_level) {
    constexpr double kHalf = 0.5, kThird = 1.0 / 3.0;
    for (const glm::dvec3& weights :
         {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(kHalf, kHalf, 0),
          glm::dvec3(0, kHalf, kHalf), glm::dvec3(kHalf, 0, kHalf), glm::dvec3(kThird)}) {
      look_at(mixed(triangle, weights), exact, tile_level);
    }
  }

  /// Measures the gap between mesh and limb at the middle of an edge between a front and a back face.
  void look_at_outline(const glm::dvec3& a_m, const glm::dvec3& b_m) {
    const auto at = project(view_, Ecef{0.5 * (a_m + b_m)});
    const auto centre = project(view_, Ecef{glm::dvec3(0.0)});
    if (!at || !centre || !in_picture(*at)) return;
    const glm::dvec2 outward = glm::normalize(*at - *centre);
    if (hits(*at + kMostSilhouette_px * outward)) return;
    double inside = 0.0, outside = kMostSilhouette_px;
    if (!hits(*at)) return;
    while (outside - inside > 1e-4) {
      const double middle = 0.5 * (inside + outside);
      (hits(*at + middle * outward) ? inside : outside) = middle;
    }
    error_.silhouette_px = std::max(error_.silhouette_px, inside);
  }

  [[nodiscard]] MeshError result() const {
    MeshError error = error_;
    if (samples_ > 0) error.position_rms_px = std::sqrt(squares_ / static_cast<double>(samples_));
    return error;
  }

 private:
  [[nodiscard]] bool in_picture(const glm::dvec2& p) const {
    return p.x >= 0.0 && p.y >= 0.0 && p.x <= view_.viewport.width_px && p.y <= view_.viewport.height_px;
  }
  [[nodiscard]] std::optional<truth::Hit> hit(const glm::dvec2& pixel) const {
    return truth::first_hit(body_, rays_.eye_m(), rays_.direction(pixel));
  }
  [[nodiscard]] bool hits(const glm::dvec2& pixel) const { return hit(pixel).has_value(); }

  void look_at(const DrawnVertex& drawn, bool exact, int tile_level) {
    const auto at = project(view_, Ecef{drawn.position_m});
    if (!at || !in_picture(*at)) return;
    const glm::dvec3 shown = glm::normalize(exact ? drawn.direction : direction_to(drawn.lon_lat_deg));
    const glm::dvec3 place_m = surface_m(shown);
    const glm::dvec3 to_eye = rays_.eye_m() - place_m;
    const double cosine = glm::dot(shown, to_eye) / glm::length(to_eye);
    if (cosine < std::cos(kClear_deg * kDegree_rad)) return;
    const auto belongs = project(view_, Ecef{place_m});
    const auto seen = hit(*at);
    if (!belongs || !seen) return;
    const double off_px = glm::length(*at - *belongs);
    error_.position_px = std::max(error_.position_px, off_px);
    squares_ += off_px * off_px;
    ++samples_;
    const double texel_rad = tile_span_deg(grid_, tile_level) / grid_.tile_px * kDegree_rad;
    error_.texture_texels = std::max(error_.texture_texels, glm::length(seen->normal - shown) / texel_rad);
  }

  [[nodiscard]] glm::dvec3 surface_m(const glm::dvec3& normal) const {
    const double squared = (1.0 - body_.f) * (1.0 - body_.f);
    const double n = body_.a_m / std::sqrt(normal.x * normal.x + normal.y * normal.y + squared * normal.z * normal.z);
    return {n * normal.x, n * normal.y, n * squared * normal.z};
  }

  const View& view_;
  truth::Spheroid body_;
  const TileGrid& grid_;
  truth::PixelRays rays_;
  MeshError error_;
  double squares_ = 0.0;
  std::int64_t samples_ = 0;
};

/// Edges with the numbers of front and back faces beside them. An edge's ends have the same bits in every patch.
class Outline {
 public:
  void add(const DrawnTriangle& t, bool front) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Point a = point(t[k].position_m), b = point(t[(k + 1) % 3].position_m);
      Edge& edge = edges_[a < b ? std::pair(a, b) : std::pair(b, a)];
      (front ? edge.fronts : edge.backs) += 1;
    }
  }
  void show(Inspector& inspector) const {
    for (const auto& [ends, edge] : edges_) {
      if (edge.fronts != 1) continue;
      const auto& [a, b] = ends;
      inspector.look_at_outline(std::apply([](auto... c) { return glm::dvec3(c...); }, a),
                                std::apply([](auto... c) { return glm::dvec3(c...); }, b));
    }
  }

 private:
  using Point = std::tuple<double, double, double>;
  struct Edge {
    int fronts = 0, backs = 0;
  };
  static Point point(const glm::dvec3& p) { return {p.x, p.y, p.z}; }
  std::map<std::pair<Point, Point>, Edge> edges_;
};

}  // namespace

MeshError mesh_error(const PatchTree& tree, const View& view, const Camera& camera,
                     const std::vector<SelectedPatch>& patches, bool exact_bands) {
  Inspector inspector(tree, view, camera);
  Outline outline;
  const PatchIndices indices = patch_indices(tree.segments());
  const ViewPlanes planes = view_planes(view);
  for (const SelectedPatch& patch : patches) {
    for_each_triangle(tree, patch, indices, [&](const DrawnTriangle& triangle) {
      if (out_of_view(triangle, view, planes)) return;
      const bool front = faces(triangle, view.eye.xyz_m);
      outline.add(triangle, front);
      if (front) inspector.look_at(triangle, exact_bands && patch.in_band, patch.tile_level);
    });
  }
  outline.show(inspector);
  return inspector.result();
}

MeshCount mesh_count(const PatchTree& tree, const View& view, const std::vector<SelectedPatch>& patches) {
  MeshCount count;
  const PatchIndices indices = patch_indices(tree.segments());
  const ViewPlanes planes = view_planes(view);
  for (const SelectedPatch& patch : patches) {
    std::int64_t needed = 0, all = 0;
    for_each_triangle(tree, patch, indices, [&](const DrawnTriangle& triangle) {
      ++all;
      needed += faces(triangle, view.eye.xyz_m) && !out_of_view(triangle, view, planes) ? 1 : 0;
    });
    ++count.patches;
    count.triangles += all;
    count.needless_triangles += all - needed;
    count.needless_patches += needed == 0 ? 1 : 0;
  }
  return count;
}

}  // namespace terrella::bench
