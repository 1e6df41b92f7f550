#include "surface/tree_growth.h"

#include <algorithm>
#include <utility>

#include "surface/relief.h"

namespace terrella {

void TreeGrowth::begin(const PatchTree& tree, const Relief* relief) {
  tree_ = &tree;
  relief_ = relief;
  kept_marks_.assign(tree.places(), 0);
  made_.clear();
  children_.clear();
  parents_.clear();
  used_.clear();
  beside_.clear();
  windows_.clear();
  lattices_.clear();
}

const PatchFamily& TreeGrowth::make_children(const PatchNode& node) {
  const std::size_t first = tree_->place_of_new_family(made_.size());
  kept_marks_.resize(std::max(kept_marks_.size(), first + 4), 0);
  marks_.resize(kept_marks_.size(), 0);
  PatchFamilyNodes& nodes = *made_.emplace_back(std::make_unique<PatchFamilyNodes>());
  parents_.push_back(&node);
  kept_marks_[node.index] |= kGrown;
  PatchFamily& family = children_[&node];
  const auto ids = terrella::children(node.id);
  for (std::size_t k = 0; k < 4; ++k) {
    nodes[k].index = static_cast<std::uint32_t>(first + k);
    nodes[k].serial = tree_->last_serial() + 4 * made_.size() - 3 + k;
    tree_->measure(nodes[k], ids[k]);
    // The parent is the tree's or the growth's own.
    nodes[k].parent = const_cast<PatchNode*>(&node);
    if (relief_ != nullptr) relief_->refresh_bounds(*tree_, nodes[k]);
    family[k] = &nodes[k];
  }
  return family;
}

const PatchNode& TreeGrowth::node(const PatchId& id) {
  const PatchNode* found = &tree_->root(id.face);
  for (int shift = id.level - 1; shift >= 0; --shift) {
    found = children(*found)[((id.x >> shift) & 1U) + 2 * ((id.y >> shift) & 1U)];
  }
  return *found;
}

// The search goes on from where it ended last; the tree forgets that where it drops the node.
const PatchNode& TreeGrowth::find_beside(const PatchNode& node, PatchSide side, const PatchNode* found) {
  const PatchId id = neighbour(node.id, side);
  if (found == nullptr) found = &tree_->root(id.face);
  while (found->id.level < id.level) {
    const PatchFamily* family = known_children(*found);
    if (family == nullptr) break;
    const int shift = id.level - found->id.level - 1;
    found = (*family)[((id.x >> shift) & 1U) + 2 * ((id.y >> shift) & 1U)];
  }
  beside_.push_back({&node, side, found});
  return *found;
}

const TileWindow& TreeGrowth::window(const PatchNode& node, int tile_level, int squeeze) {
  const auto fits = [&](const TileWindow* win) {
    return win != nullptr && win->level == tile_level && win->squeeze == squeeze;
  };
  if (fits(node.window.get())) return *node.window;
  std::unique_ptr<TileWindow>& own = windows_[&node];
  if (!fits(own.get())) {
    if (own) std::erase_if(lattices_, [&](const Lattice& l) { return l.window == own.get(); });
    own = std::make_unique<TileWindow>(tree_->make_window(node, tile_level, squeeze));
  }
  return *own;
}

const SurfaceLattice& TreeGrowth::lattice(const PatchNode& node, const TileWindow& window, int x, int y) {
  const auto cell = static_cast<std::size_t>(y) * static_cast<std::size_t>(window.w) + static_cast<std::size_t>(x);
  if (window.cells[cell].lattice != nullptr) return *window.cells[cell].lattice;
  lattices_.push_back(
      {&node, &window, cell, std::make_unique<SurfaceLattice>(tree_->make_lattice(node, window, x, y))});
  return *lattices_.back().lattice;
}

}  // namespace terrella
