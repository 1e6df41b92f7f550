#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "globe/globe.h"
#include "globe/layer_view.h"
#include "globe/tile_stream.h"
#include "render/globe_renderer.h"
#include "surface/layers.h"
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

/// Order in which the globe was asked for a source.
struct SourceTurn {
  std::uint64_t number = 0;  ///< rises with each call
  int steps_back = 0;        ///< instants that were missing before this one was tried
  bool is_ahead = false;     ///< loaded before it is asked for, with the number 0
};

/// One image layer of a globe: its tiles from the source to the GPU. Its views draw patches with them. thread: main
class ImageLayer {
 public:
  /// `gpu_bytes` is this layer's share of the budget.
  ImageLayer(LayerId id, const LayerSetup& setup, std::shared_ptr<TileSource> source, const ImageLook& look,
             std::size_t gpu_bytes);
  ImageLayer(const ImageLayer&) = delete;
  ImageLayer& operator=(const ImageLayer&) = delete;
  /// Makes the layer of plain colour that is the base layer if the lowest image layer is not opaque.
  [[nodiscard]] static std::unique_ptr<ImageLayer> make_plain(const LayerSetup& setup);

  [[nodiscard]] LayerId id() const { return id_; }
  [[nodiscard]] const SourceTurn& turn() const { return turn_; }
  void set_turn(const SourceTurn& turn) { turn_ = turn; }
  [[nodiscard]] const ImageLook& look() const { return look_; }
  void set_look(const ImageLook& look);
  /// Part of the look's opacity that the layer is drawn with: less while another instant fades in over it.
  void set_share(double share) { share_ = share; }
  [[nodiscard]] double opacity() const { return share_ * look_.opacity; }
  /// True if the layer has no instant to show at the globe's time, which it follows: it is not drawn.
  [[nodiscard]] bool is_early() const { return is_early_; }
  void set_early(bool early) { is_early_ = early; }
  /// True if the layer has the tiles that its views want, or will not get them.
  [[nodiscard]] bool is_ready() const;
  /// True if tiles are wanted in view and none of them can be had.
  [[nodiscard]] bool is_void() const;
  /// See Globe::invalidate(). What is in flight of the tile, or of all, is dropped: it may have been read before the
  /// change.
  void invalidate(const std::optional<TileId>& tile);
  /// Forgets all tiles and what is in flight, as if the layer were new. Not for the plain layer.
  void forget_tiles();
  [[nodiscard]] bool was_invalidated() const { return was_invalidated_; }
  void set_gpu_bytes(std::size_t bytes) { tiles_.set_budget(bytes); }
  /// True if a frame draws this layer. False for a night layer if the globe has no night.
  [[nodiscard]] bool is_drawn(const PictureSides& sides) const;
  /// True if the layer can be the lowest one: it hides the plain colour wherever it has tiles.
  [[nodiscard]] bool is_opaque(const PictureSides& sides) const;
  /// True if the layer hides all layers under it wherever it has tiles.
  [[nodiscard]] bool hides(const PictureSides& sides) const;
  /// True if tiles of the layer may show those under it at some places.
  [[nodiscard]] bool is_see_through() const;
  /// True if the layer needs special programs (LayerFrame::special).
  [[nodiscard]] bool is_special(const PictureSides& sides) const;
  [[nodiscard]] const std::string& attribution() const { return attribution_; }
  void set_attribution(std::string text) { attribution_ = std::move(text); }
  [[nodiscard]] const TileGrid& grid() const { return grid_; }
  [[nodiscard]] const std::vector<TileId>& roots() const { return roots_; }  ///< tiles of the coarsest level
  [[nodiscard]] double texels_per_pixel() const { return texels_per_pixel_; }
  [[nodiscard]] bool has_numbers() const { return numbers_.has_value(); }
  [[nodiscard]] NumberColors* numbers() { return numbers_ ? &*numbers_ : nullptr; }  ///< null: pictures
  /// The source of the tiles; null: plain.
  [[nodiscard]] const std::shared_ptr<TileSource>& source() const { return source_; }
  [[nodiscard]] const std::optional<TileStream<TileTexels>>& stream() const { return stream_; }  ///< none: plain
  [[nodiscard]] TileTextures& tiles() { return tiles_; }
  /// True if a resident tile is to be read again.
  [[nodiscard]] bool is_outdated(const TileId& id, const TileResidency::Entry& entry) const;
  /// See Globe::value_at(); only for a layer of numbers.
  [[nodiscard]] std::optional<LayerValue> value_at(const Geodetic& place) const;

  // The views of the layer.
  [[nodiscard]] LayerView& seen_by(ViewId view);  ///< made if it is not there
  void forget(ViewId view);
  [[nodiscard]] const std::vector<std::unique_ptr<LayerView>>& views() const { return views_; }
  void discard_patches();
  /// The vertices of the patches that the views draw; empty: drawn from those of the base layer.
  [[nodiscard]] std::unique_ptr<PatchBuffers>& vertices() { return vertices_; }
  void restore_detail();
  [[nodiscard]] std::unique_ptr<PatchTree> make_tree() const;
  /// Number of tiles that a view may want: the room that the other views leave, at least an equal share.
  [[nodiscard]] int room_for(const LayerView& view) const;
  /// True if a view holds more tiles than it has room for, because others have come.
  [[nodiscard]] bool is_crowded(const LayerView& view) const;
  /// Requests the tiles that `asking` wants, and those that the last frames of the other views still want.
  void request(const LayerView& asking);

  /// Uploads arrived tiles and returns their bytes. Appends failed tiles to `missing`.
  std::size_t take_finished(UploadAllowance& allowance, std::uint64_t frame, std::deque<MissingTile>& missing);
  /// Drops patches of `view` and states of tiles that no frame has used for long.
  void end_frame(LayerView& view, std::uint64_t frame);
  void stop_asking();

  [[nodiscard]] std::size_t gpu_bytes() const { return tiles_.bytes(); }
  [[nodiscard]] std::size_t gpu_bytes_granted() const {
    return static_cast<std::size_t>(tiles_.capacity()) * tiles_.slot_bytes();
  }
  [[nodiscard]] std::size_t tiles_known() { return tiles_.residency().entries().size(); }
  [[nodiscard]] LoaderCounts loading() const { return stream_ ? stream_->counts() : LoaderCounts{}; }

 private:
  void start_stream();
  void keep_tiles_of_views(std::size_t uploads, std::uint64_t frame);

  LayerId id_;
  SourceTurn turn_;
  Ellipsoid ellipsoid_;
  int segments_;
  CubeMapping mapping_;
  double texels_per_pixel_;
  TileGrid grid_;
  std::vector<TileId> roots_;
  ImageLook look_;
  double share_ = 1.0;
  bool is_early_ = false;
  std::string attribution_;
  TileTextures tiles_;
  std::shared_ptr<TileSource> source_;
  std::optional<TileStream<TileTexels>> stream_;
  bool was_invalidated_ = false;  ///< tiles may be outdated
  LoaderOptions loading_;
  std::chrono::milliseconds retry_after_;
  std::optional<NumberColors> numbers_;
  bool has_transparency_ = false;  ///< a loaded tile has transparent pixels
  std::unique_ptr<PatchBuffers> vertices_;
  std::vector<std::unique_ptr<LayerView>> views_;
};

}  // namespace terrella
