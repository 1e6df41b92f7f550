#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "geo/camera.h"
#include "surface/patch_id.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// A bounding sphere, ECEF metres.
struct BoundingSphere {
  glm::dvec3 center_m{0.0};
  double radius_m = 0.0;
};

/// Points of a surface, ECEF metres, row-major, kLatticeQuads + 1 a side.
struct SurfaceLattice {
  std::vector<glm::dvec3> points_m;
  double bulge_m = 0.0;  ///< the surface rises at most this far over a quad's corners
};
inline constexpr int kLatticeQuads = 4;

/// Values that a cell of a window shares with its patch.
struct CellExtent {
  BoundingSphere whole;
  glm::dvec3 up{0.0};                       ///< geodetic normal in its middle
  std::unique_ptr<SurfaceLattice> lattice;  ///< none until a plan needs it
};

/// The tiles of one level that a patch lies on: columns x0…x0+w-1, rows y0…y0+h-1. Patches do not line up with tiles;
/// each cell of the window names one tile (engine/DESIGN.md, 5). Where all rows are reduced the columns are wide ones,
/// as those of the row that is squeezed least.
struct TileWindow {
  int level = -1;
  int squeeze = 0;  ///< a cell spans 2^squeeze columns of the full grid
  std::int64_t x0 = 0, y0 = 0;
  int w = 0, h = 0;
  std::vector<CellExtent> cells;  ///< row-major
  [[nodiscard]] const CellExtent& cell(int x, int y) const {
    return cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x)];
  }
};

/// A difference of longitudes brought into [-180°, 180°]. thread: any
[[nodiscard]] double wrapped_deg(double deg);

/// Relief of a patch (surface/relief.h). It changes with the heights; without heights it keeps its first values.
struct PatchRelief {
  BoundingSphere flat;         ///< sphere that holds the patch without heights
  double flat_cone_rad = 0.0;  ///< half angle of the cone that holds the patch without heights
  double middle_m = 0.0;       ///< middle of the patch's heights, which lie within half_m of it
  double half_m = 0.0;
  std::vector<double> heights_m;  ///< heights of the vertices, in the order of patch_vertices()
  double error_m = 0.0;           ///< largest distance of the ground from the mesh between its vertices
  std::uint64_t made = 0;         ///< hash of heights_m: equal meshes have equal ones; 0: no heights
  std::uint64_t bounds_seen = 0, mesh_seen = 0;
};

struct PatchNode;
using PatchFamily = std::array<PatchNode*, 4>;

/// A patch: values that never change, computed once and kept in the tree.
struct PatchNode {
  PatchId id;
  std::uint64_t serial = 0;  ///< identifier of this node: a node that is made anew gets another; 0: dropped
  BoundingSphere sphere;
  /// Cone that holds the patch in scaled space, where the ellipsoid is the unit sphere: axis, cosine and sine of its
  /// half angle.
  glm::dvec3 cone_axis{0.0};
  double cos_cone = 1.0, sin_cone = 0.0;
  glm::dvec3 normal{0.0};          ///< geodetic normal at the centre
  double geometric_error_m = 0.0;  ///< largest distance between the mesh and the ellipsoid
  double texture_error_factor =
      1.0;  ///< interpolated texture coordinates are off by at most this times geometric_error_m
  /// Cosine and sine of the centre's longitude and of its counted latitude (graphic or centric, see row_direction()).
  glm::dvec4 frame{1.0, 0.0, 1.0, 0.0};
  double lon_center_deg = 0.0;                      ///< longitude unwraps around this
  double row_center_deg = 0.0;                      ///< row latitude of the centre
  double west_deg = 0.0, east_deg = 0.0;            ///< relative to lon_center_deg
  double south_row_deg = 0.0, north_row_deg = 0.0;  ///< row latitudes (TileGrid)
  double min_colatitude_rad = 0.0;                  ///< colatitude of the patch's point nearest to a pole
  double max_colatitude_rad = 0.0;                  ///< colatitude of the point farthest from that pole
  double row_stretch = 1.0;  ///< ground metres per row degree over those of an equirectangular row, least in the patch

  std::uint32_t index = 0;  ///< place among the existing nodes
  PatchNode* parent = nullptr;
  PatchFamily children{};              ///< all or none
  std::uint64_t children_used = 0;     ///< number of the last frame that used the children
  std::array<PatchNode*, 4> beside{};  ///< by PatchSide, across it: the deepest node found that holds that neighbour
  std::unique_ptr<TileWindow> window;  ///< tile window at the level that the last plan took
  PatchRelief relief;
};

/// The direction whose latitude the grid's rows count, not normalised: the geodetic normal, or for planetocentric
/// grids the radius vector of the surface point, (n.x, n.y, (1 - e²) n.z).
[[nodiscard]] glm::dvec3 row_direction(const TileGrid& grid, const Ellipsoid& ellipsoid, const glm::dvec3& normal);

class TreeGrowth;
using PatchFamilyNodes = std::array<PatchNode, 4>;

/// The six quadtrees of patches for one body, tile grid and tessellation. Plans make nodes (TreeGrowth), and the tree
/// drops nodes that no frame has used for long. thread: main; const functions: any, while nothing changes the tree
class PatchTree {
 public:
  /// `segments` a side of each patch: even, in [2, 128].
  PatchTree(const Ellipsoid& ellipsoid, const TileGrid& grid, int segments, CubeMapping mapping = CubeMapping::tangent);

  [[nodiscard]] PatchNode& root(CubeFace face) { return roots_[static_cast<std::size_t>(face)]; }
  [[nodiscard]] const PatchNode& root(CubeFace face) const { return roots_[static_cast<std::size_t>(face)]; }
  /// The four children, made if they are not there.
  void ensure_children(PatchNode& node);
  /// Takes the nodes that a plan made and used. The growth must have begun with the tree as it is.
  void adopt(TreeGrowth& growth);
  /// The node for changes. A plan refers to nodes of a tree that it must not change.
  [[nodiscard]] static PatchNode& own(const PatchNode& node) { return const_cast<PatchNode&>(node); }
  /// Calls visit(PatchNode&) for each node.
  template <class Visit>
  void visit_nodes(Visit visit) {
    for (PatchNode& node : roots_) visit(node);
    for (const auto& family : families_) {
      if (family) std::ranges::for_each(*family, visit);
    }
  }
  /// A node of this tree takes the bounds and the mesh of the same patch in another tree.
  static void copy_relief(const PatchNode& from, const PatchNode& to);
  /// The least squeeze (TileWindow::squeeze) of the reduced rows under a node at a level.
  [[nodiscard]] int window_squeeze(const PatchNode& node, int tile_level) const;
  /// A node's window at a tile level, its columns squeezed as given (0 or window_squeeze()).
  [[nodiscard]] TileWindow make_window(const PatchNode& node, int tile_level, int squeeze) const;
  /// Lattice of the cell (x, y) of a node's window, counted from its north-west corner.
  [[nodiscard]] SurfaceLattice make_lattice(const PatchNode& node, const TileWindow& window, int x, int y) const;

  [[nodiscard]] const Ellipsoid& ellipsoid() const { return ellipsoid_; }
  [[nodiscard]] const TileGrid& grid() const { return grid_; }
  [[nodiscard]] int segments() const { return segments_; }
  [[nodiscard]] CubeMapping mapping() const { return mapping_; }
  [[nodiscard]] std::size_t size() const { return roots_.size() + 4 * (families_.size() - free_.size()); }
  /// Ends a frame. If the tree has more than `many` nodes, and over three times as many as the frame used, it drops
  /// those used longest ago, but none that this frame used.
  void end_frame(std::size_t many = kManyNodes);

 private:
  friend class TreeGrowth;
  static constexpr std::size_t kManyNodes = 2048;

  [[nodiscard]] std::size_t places() const { return roots_.size() + 4 * families_.size(); }
  [[nodiscard]] std::uint64_t last_serial() const { return serial_; }
  /// PatchNode::index of the first node of the family that is made `k` families from now.
  [[nodiscard]] std::size_t place_of_new_family(std::size_t k) const;
  /// Fills a new node.
  void measure(PatchNode& node, const PatchId& id) const;
  void touch(PatchNode& node);
  void drop_oldest(std::size_t nodes);

  Ellipsoid ellipsoid_;
  TileGrid grid_;
  int segments_;
  CubeMapping mapping_;
  std::uint64_t serial_ = 0;
  std::array<PatchNode, kCubeFaces> roots_;
  std::vector<std::unique_ptr<PatchFamilyNodes>> families_;
  std::vector<std::size_t> free_;  ///< places in families_ that hold none
  std::uint64_t frame_ = 1;
  std::size_t used_ = 0;  ///< nodes that this frame used
};

}  // namespace terrella
