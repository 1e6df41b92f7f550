#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "surface/patch_tree.h"
#include "surface/selected_patch.h"

namespace terrella {

class Relief;

/// Additions of a plan to a tree: nodes, windows and marks. The tree stays as it is until PatchTree::adopt() takes the
/// growth. A growth is valid until another one was adopted or the tree's frame ended. thread: any, one at a time
class TreeGrowth {
 public:
  TreeGrowth() = default;
  /// See begin().
  explicit TreeGrowth(const PatchTree& tree, const Relief* relief = nullptr) { begin(tree, relief); }

  /// Forgets everything and begins with the tree as it is. `relief`: raises the bounds of new nodes; none: the
  /// ellipsoid.
  void begin(const PatchTree& tree, const Relief* relief = nullptr);
  /// The four children, made if they are not there. The node counts as used in this frame.
  [[nodiscard]] const PatchFamily& children(const PatchNode& node) {
    std::uint8_t& mark = kept_marks_[node.index];
    if ((mark & kUsed) == 0) used_.push_back(&node);
    mark |= kUsed;
    const PatchFamily* known = known_children(node);
    return known != nullptr ? *known : make_children(node);
  }
  /// The four children in the tree or the growth; nullptr if they were never made.
  [[nodiscard]] const PatchFamily* known_children(const PatchNode& node) const {
    if (node.children[0] != nullptr) return &node.children;
    return (kept_marks_[node.index] & kGrown) == 0 ? nullptr : &children_.at(&node);
  }
  /// Returns the node of this id in the tree or the growth; makes the node if there is none.
  [[nodiscard]] const PatchNode& node(const PatchId& id);
  /// The deepest node that holds the neighbour across a side.
  [[nodiscard]] const PatchNode& beside(const PatchNode& node, PatchSide side) {
    const PatchNode* found = node.beside[static_cast<std::size_t>(side)];
    const bool deepest = found != nullptr && (found->id.level == node.id.level || known_children(*found) == nullptr);
    return deepest ? *found : find_beside(node, side, found);
  }
  /// The node's window at a tile level, its columns squeezed as given (0 or window_squeeze()).
  [[nodiscard]] const TileWindow& window(const PatchNode& node, int tile_level, int squeeze);
  /// Lattice of the cell (x, y) of the node's window that was asked for last.
  [[nodiscard]] const SurfaceLattice& lattice(const PatchNode& node, const TileWindow& window, int x, int y);

  /// A new selection begins: no node is a leaf or split.
  void clear_selection() { marks_.assign(kept_marks_.size(), 0); }
  [[nodiscard]] bool is_leaf(const PatchNode& node) const { return (marks_[node.index] & kLeaf) != 0; }
  [[nodiscard]] bool is_split(const PatchNode& node) const { return (marks_[node.index] & kSplit) != 0; }
  /// True the first time in a selection.
  [[nodiscard]] bool mark_mesh(const PatchNode& node) {
    const bool first = (marks_[node.index] & kMesh) == 0;
    marks_[node.index] |= kMesh;
    return first;
  }
  void mark_leaf(const PatchNode& node) { marks_[node.index] |= kLeaf; }
  void mark_split(const PatchNode& node) {
    marks_[node.index] = static_cast<std::uint8_t>((marks_[node.index] | kSplit) & ~kLeaf);
  }

  /// True if both make and use the same nodes, and as many windows and lattices.
  [[nodiscard]] bool operator==(const TreeGrowth& other) const {
    return parents_ == other.parents_ && used_ == other.used_ && windows_.size() == other.windows_.size() &&
           lattices_.size() == other.lattices_.size();
  }

 private:
  friend class PatchTree;
  static constexpr std::uint8_t kUsed = 1, kGrown = 2;             // bits of kept_marks_
  static constexpr std::uint8_t kLeaf = 1, kSplit = 2, kMesh = 4;  // bits of marks_

  struct Beside {
    const PatchNode* node;
    PatchSide side;
    const PatchNode* found;
  };
  struct Lattice {
    const PatchNode* node;
    const TileWindow* window;
    std::size_t cell;
    std::unique_ptr<SurfaceLattice> lattice;
  };

  const PatchFamily& make_children(const PatchNode& node);
  const PatchNode& find_beside(const PatchNode& node, PatchSide side, const PatchNode* found);

  const PatchTree* tree_ = nullptr;
  const Relief* relief_ = nullptr;
  std::vector<std::uint8_t> kept_marks_;  ///< by PatchNode::index
  std::vector<std::uint8_t> marks_;       ///< the same, of one selection
  std::vector<std::unique_ptr<PatchFamilyNodes>> made_;
  std::unordered_map<const PatchNode*, PatchFamily> children_;  ///< children of nodes with kGrown
  std::vector<NodeRef> parents_;                                ///< parents of the families in made_
  std::vector<NodeRef> used_;
  std::vector<Beside> beside_;
  std::unordered_map<const PatchNode*, std::unique_ptr<TileWindow>> windows_;
  std::vector<Lattice> lattices_;
};

}  // namespace terrella
