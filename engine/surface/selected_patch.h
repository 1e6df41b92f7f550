#pragma once

#include <vector>

#include "surface/patch_tree.h"

namespace terrella {

/// A node in a plan. Two are equal if they name the same patch. thread: any
class NodeRef {
 public:
  NodeRef(const PatchNode* node = nullptr)
      : node_(node) {}  // NOLINT(google-explicit-constructor): stands for a pointer

  [[nodiscard]] const PatchNode& operator*() const { return *node_; }
  [[nodiscard]] const PatchNode* operator->() const { return node_; }
  [[nodiscard]] explicit operator bool() const { return node_ != nullptr; }
  [[nodiscard]] bool operator==(const NodeRef& other) const {
    return node_ == other.node_ || (node_ != nullptr && other.node_ != nullptr && node_->id == other.node_->id);
  }

 private:
  const PatchNode* node_;
};

/// One patch to draw.
struct SelectedPatch {
  NodeRef node;
  int tile_level = 0;         ///< tile level of its window
  bool squeezed = true;       ///< takes squeezed tiles where there are any, at that level; else those of the full grid
  int squeeze = 0;            ///< squeeze of its window
  unsigned coarse_sides = 0;  ///< bit k: the neighbour across PatchSide k is one level coarser
  bool in_band = false;       ///< needs per-fragment coordinates
  bool cut_by_view = false;   ///< part of it may be out of view: its cells are worth testing one by one
  double pixel_m = 1.0;       ///< length of a pixel on the nearest part of the patch, across the line of sight
  double footprint_texels = 1.0;  ///< longest extent of a pixel on the patch, in texels of tile_level, estimated
  NodeRef surface{};              ///< in a further layer: the node of the lowest layer's tree that it lies on

  /// The node that knows the patch's bounds.
  [[nodiscard]] const PatchNode& body() const { return surface ? *surface : *node; }
  bool operator==(const SelectedPatch&) const = default;
};

}  // namespace terrella
