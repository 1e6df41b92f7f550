#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "geo/camera.h"
#include "geo/height_tile.h"
#include "scene/height_field.h"
#include "scene/patch_selection.h"
#include "scene/patch_tree.h"
#include "scene/tile_coverage.h"

namespace terrella {

/// The ground of a body: which heights a view asks for, and what the heights that are there make of patches. A height
/// raises a point along its geodetic normal, and is a function of the point alone, so patches that share a vertex raise
/// it alike and texture coordinates stay what they were. thread: main
class Relief {
 public:
  /// `exaggeration` is applied to what is drawn, picked and collided with.
  Relief(const Ellipsoid& ellipsoid, const TileGrid& grid, double exaggeration, std::size_t budget_bytes = 256UL << 20);

  [[nodiscard]] const TileGrid& grid() const { return field_.grid(); }
  [[nodiscard]] double exaggeration() const { return exaggeration_; }

  /// A tile has come; what lies under it is raised anew.
  void add(HeightTile tile);
  /// The source lacks it for good: its ancestors serve.
  void set_lacking(const TileId& id) { lacking_.insert_or_assign(id, true); }
  /// Height of the drawn ground over the ellipsoid where the finest tiles that are there say it, metres.
  [[nodiscard]] double height_m(Angle lat, Angle lon) const { return field_.height_m(lat, lon, exaggeration_); }
  /// Of all that was ever drawn from.
  [[nodiscard]] GroundRange range_m() const { return range_; }

  /// Brings a node's bounds up to date with the heights: its sphere, the cone that the horizon is tested by.
  void refresh_bounds(const PatchTree& tree, PatchNode& node);
  /// The heights of its vertices, the slopes there and how far the ground lies from the mesh between them.
  void refresh_mesh(const PatchTree& tree, PatchNode& node);

  /// The tiles that the patches of a view want and that are neither there nor lacking; the coarsest level always. Tiles
  /// that no view has wanted for long give way to the budget.
  [[nodiscard]] std::vector<WantedTile> want(const PatchTree& tree, const std::vector<SelectedPatch>& patches);

 private:
  /// Where heights have changed, degrees; row latitudes of the heights' grid.
  struct Change {
    double west, east, south, north;
  };
  [[nodiscard]] bool touches(const PatchTree& tree, const PatchNode& node, const Change& change) const;
  [[nodiscard]] bool changed_since(const PatchTree& tree, const PatchNode& node, std::size_t since) const;
  void note_change(const TileId& id);
  void want_tile(const TileId& id, double priority, std::vector<WantedTile>& wanted);
  void keep_to_budget();

  Ellipsoid ellipsoid_;
  HeightField field_;
  double exaggeration_;
  std::size_t most_tiles_;
  std::vector<Change> changes_;
  GroundRange range_;
  std::unordered_map<TileId, bool, TileIdHash> lacking_;
  std::unordered_map<TileId, std::uint64_t, TileIdHash> last_wanted_;
  std::uint64_t round_ = 0;
};

}  // namespace terrella
