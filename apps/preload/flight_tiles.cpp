#include "apps/preload/flight_tiles.h"

#include <algorithm>
#include <cmath>
#include <memory>
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
constexpr double kLowest_m = 0.1;              // lowest height of the eye
constexpr double kShortestStep = 1e-7;         // as a fraction of the flight
constexpr std::size_t kMostPatches = 100'000;  // kept from one view to the next

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

/// Number of steps between two views that lie near each other.
double steps_between(const Camera& a, const Camera& b, const FlightView& view) {
  const double radius_m = view.body.ellipsoid.a_m();
  const double way_m = radius_m * angle_between(eye_normal(a), eye_normal(b)).rad();
  const double side_m = 2.0 * std::max(a.eye.height_m, kLowest_m) * std::tan(0.5 * a.fov_y.rad());
  const double tile_m = Angle::degrees(tile_span_deg(view.grid, view.grid.max_level)).rad() * radius_m;
  const double step_m = std::max(kStepOfPicture * std::min(side_m, radius_m), kStepOfTile * tile_m);
  const double turn = std::abs((b.heading - a.heading).rad()) + std::abs((b.pitch - a.pitch).rad());
  return way_m / step_m + std::abs(log_height(a) - log_height(b)) / kStepOfLogHeight +
         turn / (kStepOfPicture * a.fov_y.rad());
}

/// Looks from a keyframe on, up to the next one.
void look_along(const FlightPath& path, std::size_t section, const FlightView& view, Gatherer& gatherer) {
  const double end_s = path.times()[section + 1];
  double step_s = end_s - path.times()[section];
  for (double time_s = path.times()[section]; time_s < end_s;) {
    const Camera camera = path.at(time_s).camera;
    gatherer.look(camera);
    const double shortest_s = kShortestStep * path.duration_s();
    step_s = std::max(std::min(step_s, end_s - time_s), shortest_s);
    while (step_s > shortest_s && steps_between(camera, path.at(time_s + step_s).camera, view) > 1.0) step_s *= 0.5;
    time_s += step_s;
    step_s *= 2.0;
  }
}

}  // namespace

std::vector<TileId> tiles_along(const std::vector<FlightPath>& paths, const FlightView& view) {
  Gatherer gatherer(view);
  for (const FlightPath& path : paths) {
    for (std::size_t i = 0; i + 1 < path.times().size(); ++i) look_along(path, i, view, gatherer);
    gatherer.look(path.at(path.duration_s()).camera);
  }
  return gatherer.take();
}

}  // namespace terrella
