#include "apps/preload/flight_tiles.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <unordered_set>

#include "geo/ellipsoid.h"
#include "surface/plan/patch_selection.h"
#include "surface/plan/tile_coverage.h"
#include "tiles/tile_range.h"

namespace terrella {
namespace {

constexpr int kSegments = 24;                  // segments per patch side, as in the globe
constexpr double kStepOfPicture = 0.05;        // fraction of the picture's visible width
constexpr double kStepOfTile = 0.02;           // smallest step, as a fraction of a finest tile's side
constexpr double kStepOfLogHeight = 0.05;      // 1/13 of the way to the next level
constexpr double kLowest_m = 0.1;              // heights are interpolated by their logarithm
constexpr std::size_t kMostPatches = 100'000;  // kept from one view to the next

double log_height(const Camera& camera) { return std::log(std::max(camera.eye.height_m, kLowest_m)); }

/// Collects the tiles of many views.
class Gatherer {
 public:
  explicit Gatherer(const FlightView& view) : view_(view), tree_(new_tree()) {
    for (const TileId& id : root_tiles(view.grid)) tiles_.insert(id);
  }

  void look(const Camera& camera) {
    if (tree_->size() > kMostPatches) tree_ = new_tree();
    const View view = make_view(camera, view_.body.ellipsoid, view_.size);
    select_patches(*tree_, view, {}, patches_);
    const TileResidency nothing_yet;
    TreeGrowth growth(*tree_);
    cover_with_tiles({.tree = *tree_, .growth = growth, .view = view, .patches = patches_, .residency = nothing_yet},
                     coverage_);
    tree_->adopt(growth);
    for (const WantedTile& wanted : coverage_.wanted) add_with_ancestors(wanted.id);
  }

  [[nodiscard]] std::vector<TileId> take() const { return {tiles_.begin(), tiles_.end()}; }

 private:
  [[nodiscard]] std::unique_ptr<PatchTree> new_tree() const {
    return std::make_unique<PatchTree>(view_.body.ellipsoid, view_.grid, kSegments);
  }
  void add_with_ancestors(TileId id) {
    while (tiles_.insert(id).second && id.level > view_.grid.min_level) id = parent(id);
  }

  const FlightView& view_;
  std::unique_ptr<PatchTree> tree_;
  std::vector<SelectedPatch> patches_;
  TileCoverage coverage_;
  std::unordered_set<TileId, TileIdHash> tiles_;
};

/// Number of steps for a whole segment, if all of the segment were like the part around a camera.
double steps_at(const Camera& camera, const Camera& a, const Camera& b, const FlightView& view) {
  const glm::dvec3 from = Ellipsoid::normal(a.eye.lat, a.eye.lon).xyz;
  const glm::dvec3 to = Ellipsoid::normal(b.eye.lat, b.eye.lon).xyz;
  const double radius_m = view.body.ellipsoid.a_m();
  const double way_m = radius_m * std::atan2(glm::length(glm::cross(from, to)), glm::dot(from, to));
  const double side_m = 2.0 * std::max(camera.eye.height_m, kLowest_m) * std::tan(0.5 * camera.fov_y.rad());
  const double tile_m = Angle::degrees(tile_span_deg(view.grid, view.grid.max_level)).rad() * radius_m;
  const double step_m = std::max(kStepOfPicture * std::min(side_m, radius_m), kStepOfTile * tile_m);
  return way_m / step_m + std::abs(log_height(a) - log_height(b)) / kStepOfLogHeight;
}

}  // namespace

Camera camera_between(const Camera& a, const Camera& b, double t) {
  const glm::dvec3 from = Ellipsoid::normal(a.eye.lat, a.eye.lon).xyz;
  const glm::dvec3 to = Ellipsoid::normal(b.eye.lat, b.eye.lon).xyz;
  const double angle = std::atan2(glm::length(glm::cross(from, to)), glm::dot(from, to));
  Camera camera = a;
  if (std::sin(angle) > 1e-12) {
    const glm::dvec3 n = (std::sin((1.0 - t) * angle) * from + std::sin(t * angle) * to) / std::sin(angle);
    camera.eye = Ellipsoid::lat_lon(EcefDir{glm::normalize(n)});
  }
  camera.eye.height_m = std::exp((1.0 - t) * log_height(a) + t * log_height(b));
  return camera;
}

std::vector<TileId> tiles_along(const std::vector<std::vector<Camera>>& ways, const FlightView& view) {
  Gatherer gatherer(view);
  for (const std::vector<Camera>& way : ways) {
    for (std::size_t i = 0; i + 1 < way.size(); ++i) {
      for (double t = 0.0; t < 1.0;) {
        const Camera camera = camera_between(way[i], way[i + 1], t);
        gatherer.look(camera);
        t += 1.0 / std::max(1.0, steps_at(camera, way[i], way[i + 1], view));
      }
    }
    gatherer.look(way.back());
  }
  return gatherer.take();
}

}  // namespace terrella
