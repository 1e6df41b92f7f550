#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "geo/camera.h"
#include "surface/height_field.h"
#include "surface/patch_tree.h"
#include "surface/selected_patch.h"
#include "surface/wanted_tile.h"
#include "tiles/height_tile.h"
#include "tiles/tile_residency.h"
#include "view/ground.h"

namespace terrella {

/// The ground of a body: requests the heights that a view wants, and raises patches by the loaded heights. A height
/// raises a point along its geodetic normal and depends on the point alone. So patches that share a vertex raise it
/// alike, and texture coordinates stay the same. thread: main; const functions: any, while nothing changes the relief
class Relief : public GroundHeights {
 public:
  /// `exaggeration` is the factor of heights for drawing, picking and collisions.
  Relief(const Ellipsoid& ellipsoid, const TileGrid& grid, double exaggeration, std::size_t budget_bytes = 256UL << 20);

  [[nodiscard]] const TileGrid& grid() const { return field_.grid(); }
  [[nodiscard]] const HeightField& field() const { return field_; }
  [[nodiscard]] double exaggeration() const { return exaggeration_; }

  /// Raises everything anew.
  void set_exaggeration(double exaggeration);
  /// Adds a loaded tile. Patches on it are raised anew.
  void add(HeightTile tile);
  /// States of the tiles. A missing tile's ancestors serve instead.
  [[nodiscard]] TileResidency& tiles() { return tiles_; }
  [[nodiscard]] int missing() const { return static_cast<int>(tiles_.count(TileState::missing)); }
  /// Height of the drawn ground over the ellipsoid, metres, from the finest loaded tile.
  [[nodiscard]] double height_m(Angle lat, Angle lon) const override {
    return field_.height_m(lat, lon, exaggeration_);
  }
  [[nodiscard]] std::optional<double> intersect_m(const Ecef& origin, const EcefDir& direction,
                                                  double radians_per_px) const override;
  /// Lowest and highest height in any tile loaded so far, exaggerated.
  [[nodiscard]] GroundRange range_m() const {
    return {.min_m = exaggeration_ * range_.min_m, .max_m = exaggeration_ * range_.max_m};
  }

  /// Number of these patches whose meshes a new tile puts out of date.
  [[nodiscard]] int touched(const PatchTree& tree, const TileId& id, const std::vector<SelectedPatch>& patches) const;

  /// Bytes of the loaded tiles.
  [[nodiscard]] std::size_t bytes() const { return field_.size() * tile_bytes_; }

  /// Brings the bounds of a tree's nodes up to date with the heights: their spheres, and their cones for the horizon.
  void refresh_bounds(PatchTree& tree) const;
  void refresh_bounds(const PatchTree& tree, PatchNode& node) const;
  /// Counts the changes of heights.
  [[nodiscard]] std::uint64_t changes_seen() const { return changes_forgotten_ + changes_.size(); }
  /// True if make_meshes() would make the mesh.
  [[nodiscard]] bool is_stale(const PatchTree& tree, const PatchNode& node) const {
    return node.relief.heights_m.empty() || changed_since(tree, node, node.relief.mesh_seen);
  }
  /// True if heights of the tile, or beside it, may have changed since changes_seen() was `since`.
  [[nodiscard]] bool changed_since(const TileId& id, std::uint64_t since) const;
  [[nodiscard]] bool changed_since(const Geodetic& place, std::uint64_t since) const;  ///< the same of a place
  /// Makes the meshes of nodes whose heights have changed: the heights of their vertices, and the error between them.
  /// Returns the number of meshes made.
  int make_meshes(PatchTree& tree, const std::vector<NodeRef>& nodes) const;

  /// The tiles that the patches of a view want and that are in TileState::unknown; the coarsest level always. Tiles
  /// that no view has wanted for long are evicted when the budget is used up.
  [[nodiscard]] std::vector<WantedTile> want(const std::vector<SelectedPatch>& patches);
  /// Appends the tiles that the patches of another view want besides. Call it after want(), so that the tiles of all
  /// views count as wanted at the same time.
  void want_too(const std::vector<SelectedPatch>& patches, std::vector<WantedTile>& wanted);

 private:
  /// A rectangle in which heights have changed, degrees; row latitudes of the heights' grid.
  struct Change {
    double west, east, south, north;
  };
  [[nodiscard]] bool touches(const PatchTree& tree, const PatchNode& node, const Change& change) const;
  [[nodiscard]] Change change_of(const TileId& id) const;
  [[nodiscard]] bool changed_since(const PatchTree& tree, const PatchNode& node, std::uint64_t since) const;
  void note_change(const Change& change);
  bool refresh_mesh(const PatchTree& tree, PatchNode& node) const;
  void measure_vertices(const PatchTree& tree, PatchNode& node) const;
  void measure_error(const PatchTree& tree, PatchNode& node) const;
  void want_tile(const TileId& id, double priority, std::vector<WantedTile>& wanted);
  void stamp(TileResidency::Entry& entry) const;
  void keep_to_budget();

  Ellipsoid ellipsoid_;
  HeightField field_;
  const std::vector<TileId> roots_;  ///< tiles of the coarsest level
  double exaggeration_;
  std::size_t tile_bytes_;
  std::size_t most_tiles_;
  std::deque<Change> changes_;  ///< the latest ones
  std::uint64_t changes_forgotten_ = 0;
  GroundRange range_;  ///< as the tiles have it
  TileResidency tiles_;
  std::uint64_t round_ = 0;  ///< counts calls of want()
};

}  // namespace terrella
