#pragma once

#include <epoxy/gl.h>

#include <cstdint>
#include <glm/vec4.hpp>
#include <unordered_map>
#include <vector>

#include "render/gl/gl_handle.h"
#include "render/surface/patch_layer.h"
#include "surface/plan/tile_coverage.h"
#include "surface/slope_window.h"

namespace terrella {

/// The slopes of loaded heights in slots of an array texture, for programs built with RELIEF
/// (shaders/surface/patch_relief.glsl). A slot has a texel per height, and a gutter for filtering. Slot 0 is level. The
/// slopes are not exaggerated. At most 64 MiB on the GPU for each view, or the tiles of one frame if they are more than
/// that and the driver has room for them. Ground without a slot is drawn as level. thread: main
class SlopeTextures {
 public:
  static constexpr GLuint kUnit = 9, kCellsUnit = 10;  ///< texture units that the shaders read
  static constexpr int kGutter_px = 1;                 ///< reach of filtering, and room for rounding

  explicit SlopeTextures(const TileGrid& grid);

  /// Sets the number of views that are drawn in turn.
  void set_views(int views);
  /// Uploads the windows of a layer's patches, and the slopes of tiles that are new or whose heights have changed.
  void upload(PatchLayer& layer, const Relief& relief, const PatchTree& tree, const std::vector<SelectedPatch>& patches,
              std::uint64_t frame);
  /// Binds the slopes, and the cells of a layer.
  void bind(const PatchLayer& layer) const;

  [[nodiscard]] const TileGrid& grid() const { return grid_; }
  /// Side of a tile over the side of its slot, both in texels.
  [[nodiscard]] double slot_share() const { return static_cast<double>(grid_.tile_px) / slot_px(); }

 private:
  struct Slot {
    int layer = 0;
    std::uint64_t last_used = 0;
    std::uint64_t changes_seen = 0;
  };
  [[nodiscard]] int slot_px() const { return grid_.tile_px + 2 * kGutter_px; }
  [[nodiscard]] WindowCell cell_of(const Relief& relief, TileId id, std::uint64_t frame);
  [[nodiscard]] int layer_of(const Relief& relief, const TileId& id, std::uint64_t frame);
  [[nodiscard]] int free_layer(std::uint64_t frame);
  [[nodiscard]] bool grow();

  TileGrid grid_;
  int most_layers_ = 0;
  int layers_ = 0, used_ = 1;
  bool has_memory_ = true;  ///< false: the driver has none for more layers
  gl::Texture texture_;
  gl::Sampler sampler_;
  std::unordered_map<TileId, Slot, TileIdHash> slots_;
};

/// The place of a patch in the windows of slopes, as the shader programs take it.
struct SlopeDraw {
  glm::vec4 center_and_scale;
  glm::uvec4 window;  ///< as PatchDraw::window
};

}  // namespace terrella
