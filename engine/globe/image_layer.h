#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "globe/globe.h"
#include "globe/tile_stream.h"
#include "render/globe_renderer.h"
#include "surface/layers.h"
#include "surface/plan/frame_plan.h"
#include "tiles/tile_loader.h"

namespace terrella {

/// The uploads that a frame may still make.
struct UploadAllowance {
  std::size_t bytes = 0;
  std::chrono::steady_clock::time_point deadline;
};

/// The parts of a globe with which its layers are made.
struct LayerSetup {
  const GlobeOptions& options;
  CubeMapping mapping;
  std::shared_ptr<ArrivalBell> bell;  ///< rings when a tile has arrived
};

/// One image layer of a globe: its tiles from the source to the GPU, and the patches that a frame draws with them.
/// thread: main
class ImageLayer {
 public:
  /// `gpu_bytes` is this layer's share of the budget.
  ImageLayer(LayerId id, const LayerSetup& setup, std::shared_ptr<TileSource> source, const ImageLook& look,
             std::size_t gpu_bytes);
  /// Makes the layer of plain colour that is the base layer if the lowest image layer is not opaque.
  [[nodiscard]] static std::unique_ptr<ImageLayer> make_plain(const LayerSetup& setup);

  [[nodiscard]] LayerId id() const { return id_; }
  [[nodiscard]] const ImageLook& look() const { return look_; }
  void set_look(const ImageLook& look);
  void discard_patches();
  /// See Globe::invalidate(). Tiles in flight are dropped: they may have been read before the change.
  void invalidate(const std::optional<TileId>& tile);
  void set_gpu_bytes(std::size_t bytes) { tiles_.set_budget(bytes); }
  /// True if a frame draws this layer. False for a night layer if the globe has no night.
  [[nodiscard]] bool is_drawn(bool has_night) const;
  /// True if the layer hides all layers under it wherever it has tiles.
  [[nodiscard]] bool is_opaque(bool has_night) const;
  /// True if the layer needs special programs: it shows on one side of the terminator, or brightness is its alpha.
  [[nodiscard]] bool is_special(bool has_night) const;
  [[nodiscard]] const std::string& attribution() const { return attribution_; }
  void set_attribution(std::string text) { attribution_ = std::move(text); }
  /// True if the last frame drew some of its tiles in view.
  [[nodiscard]] bool is_on_screen() const { return coverage_.shown; }
  [[nodiscard]] const TileGrid& grid() const { return grid_; }
  [[nodiscard]] bool has_numbers() const { return gpu_.numbers.has_value(); }
  /// The source of the tiles; null: plain.
  [[nodiscard]] const std::shared_ptr<TileSource>& source() const { return source_; }
  /// See Globe::value_at(); only for a layer of numbers.
  [[nodiscard]] std::optional<LayerValue> value_at(const Geodetic& place) const;

  [[nodiscard]] PatchTree& tree() { return *tree_; }
  [[nodiscard]] std::vector<SelectedPatch>& patches() { return patches_; }
  [[nodiscard]] const std::vector<SelectedPatch>& patches() const { return patches_; }
  [[nodiscard]] const TileCoverage& coverage() const { return coverage_; }
  void restore_detail() { detail_ = 1.0; }
  /// The layer as a plan reads it.
  [[nodiscard]] LayerSnapshot snapshot();
  /// Takes a plan over: patches, tiles and their use, nodes for the tree. The plan gets the last frame's memory.
  void execute(LayerPlan& plan, std::uint64_t frame);
  void copy_relief();  ///< from the patches of the base layer, on which this upper layer lies

  /// Uploads arrived tiles and returns their bytes. Appends failed tiles to `missing`.
  std::size_t take_finished(UploadAllowance& allowance, std::uint64_t frame, std::deque<MissingTile>& missing);
  void ask();
  void end_frame(std::uint64_t frame);  ///< evicts and forgets what frames have not used for long
  void stop_asking();
  [[nodiscard]] LayerFrame frame(bool is_base, bool has_night);

  [[nodiscard]] std::size_t gpu_bytes() const { return tiles_.bytes(); }
  [[nodiscard]] std::size_t tiles_known() { return tiles_.residency().entries().size(); }
  [[nodiscard]] bool settled();
  [[nodiscard]] LoaderCounts loading() const { return stream_ ? stream_->counts() : LoaderCounts{}; }
  /// See TileStream::has_news(). Also true if the source has a new edition.
  [[nodiscard]] bool has_news() const { return stream_ && (stream_->has_news() || source_->edition() != edition_); }

 private:
  void start_stream();
  void add_outdated(std::vector<TileRequest>& requests);

  LayerId id_;
  Ellipsoid ellipsoid_;
  int segments_;
  CubeMapping mapping_;
  double texels_per_pixel_;
  TileGrid grid_;
  std::vector<TileId> roots_;
  ImageLook look_;
  std::string attribution_;
  std::unique_ptr<PatchTree> tree_;
  TileTextures tiles_;
  std::shared_ptr<TileSource> source_;            ///< null: plain
  std::optional<TileStream<TileTexels>> stream_;  ///< none: plain
  std::uint64_t edition_ = 0;                     ///< of the source, at the last request
  bool was_invalidated_ = false;                  ///< tiles may be outdated
  int outdated_drawn_ = 0;                        ///< outdated tiles that the last frame drew
  std::uint64_t frame_ = 0;                       ///< number of the last frame
  LoaderOptions loading_;
  std::chrono::milliseconds retry_after_;
  PatchLayer gpu_;
  std::vector<SelectedPatch> patches_;
  TileCoverage coverage_;
  double detail_ = 1.0;            ///< part of texels_per_pixel_ that views have room for
  bool has_transparency_ = false;  ///< a loaded tile has transparent pixels
};

}  // namespace terrella
