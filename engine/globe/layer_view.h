#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "globe/tile_stream.h"
#include "render/globe_renderer.h"
#include "surface/plan/frame_plan.h"
#include "tiles/tile_loader.h"

namespace terrella {

class ImageLayer;

/// Identifier of a view, unique within its globe.
enum class ViewId : std::uint64_t {};

/// Lines that may divide a picture between its layers.
struct PictureSides {
  bool night = false;  ///< the terminator
  bool swipe = false;  ///< SurfaceLook::swipe
};

/// One image layer as one view draws it: the patches, and the tiles that they want. ImageLayer holds the tiles, which
/// all views share. thread: main
class LayerView {
 public:
  LayerView(ImageLayer& layer, ViewId view) : layer_(layer), view_(view) { discard_patches(); }

  [[nodiscard]] ViewId view() const { return view_; }
  [[nodiscard]] ImageLayer& layer() const { return layer_; }
  [[nodiscard]] PatchTree& tree() { return *tree_; }
  [[nodiscard]] const PatchTree& tree() const { return *tree_; }
  [[nodiscard]] const std::vector<SelectedPatch>& patches() const { return patches_; }
  [[nodiscard]] const TileCoverage& coverage() const { return coverage_; }
  /// True if the last frame drew some of the layer's tiles in view.
  [[nodiscard]] bool is_on_screen() const { return coverage_.shown; }
  /// True if in the last frame the layer hid all layers under it wherever it has tiles.
  [[nodiscard]] bool hides() const { return hides_; }
  /// True if some cell of a patch, or every cell, has a tile.
  [[nodiscard]] bool has_tiles(std::size_t patch) const;
  [[nodiscard]] bool is_full(std::size_t patch) const;
  void discard_patches();
  void restore_detail() { detail_ = 1.0; }

  /// The layer as a plan reads it.
  [[nodiscard]] LayerSnapshot snapshot();
  /// Takes a plan over: patches, tiles and their use, nodes for the tree. The plan gets the last frame's memory.
  void execute(LayerPlan& plan, std::uint64_t frame);
  void copy_relief();  ///< from the patches of the base layer, on which this upper layer lies
  void ask();          ///< requests the tiles that the frame wants
  void stop_asking() { requests_.clear(); }
  [[nodiscard]] const std::vector<TileRequest>& requests() const { return requests_; }
  /// Marks the tiles that the view's last frame needs as needed in a later frame, so that they are not evicted.
  void keep_tiles(std::uint64_t frame) const;
  [[nodiscard]] LayerFrame frame(bool is_base, const PictureSides& sides);

  [[nodiscard]] bool settled() const;
  /// True if a frame of the view would have something to do: see TileStream::has_news(); or the source has a new
  /// edition, or other views have taken room.
  [[nodiscard]] bool has_news() const;

 private:
  void add_outdated();

  ImageLayer& layer_;
  ViewId view_;
  std::unique_ptr<PatchTree> tree_;
  PatchLayer gpu_;
  std::vector<SelectedPatch> patches_;
  TileCoverage coverage_;
  int room_ = 0;  ///< tiles that the last plan might want
  bool hides_ = false;
  double detail_ = 1.0;  ///< part of the layer's texels_per_pixel that the view has room for
  std::vector<TileRequest> requests_;
  StreamCounts seen_;          ///< counts of the layer's stream at the last request
  std::uint64_t edition_ = 0;  ///< edition of the source at the last request
  int outdated_drawn_ = 0;     ///< outdated tiles that the last frame drew
  std::uint64_t frame_ = 0;    ///< number of the view's last frame
};

}  // namespace terrella
