#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "geo/camera.h"
#include "objects/object_batches.h"
#include "render/gl/frame_block.h"
#include "render/gl/gl_handle.h"
#include "render/objects/icon_pass.h"
#include "render/objects/label_pass.h"
#include "render/objects/layer_buffers.h"
#include "render/objects/mesh_pass.h"
#include "render/objects/solid_pass.h"
#include "render/objects/sphere_pass.h"
#include "view/render_modes.h"

namespace terrella {

/// Draws the objects of layers: areas, extruded areas, spheres, meshes, lines, markers, icons, labels. All positions
/// are relative to the eye. thread: main
class ObjectPass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<ObjectPass>> create(DepthMode depth);

  /// Sets the layers to draw, the lowest first. They must stay until the next call.
  void set_layers(std::vector<DrawnLayer> layers);
  /// Makes the programs that the layers need and no earlier ones needed.
  Status prepare();
  /// Uploads the changes of the layers. Call it before drawing. Layers for which the driver has no memory are not
  /// drawn; the next call tries again.
  void upload();
  /// False if the last upload() left out a layer.
  [[nodiscard]] bool has_memory() const { return layers_.size() == given_.size(); }
  [[nodiscard]] bool has(ObjectPart part) const;

  /// Sets the font of labels, the bytes of a font file. Without a font, no labels are drawn.
  void set_label_font(std::vector<std::byte> font) { font_ = std::move(font); }
  /// Letters of labels that no font has, so far, in ascending order.
  [[nodiscard]] std::u32string without_font() const;
  /// Chooses the labels of a frame, which `shown` remembers. Before the first call, no labels are drawn.
  void place_labels(const View& view, const LabelSight& sight, ShownLabels& shown) {
    if (labels_) labels_->place(view, sight, layers_, shown);
  }

  /// Draws one part into the bound framebuffer with the depth test, stencil and color mask of `state`. The caller has
  /// set the viewport (its size is `viewport`) and the frame's uniform block (binding 0; `frame` is its content).
  /// Opaque objects write depth. Translucent ones come after them and do not. Objects over or on the ground are drawn a
  /// little towards the eye, objects under the ground are not. Returns the draw calls made: at most one for each of
  /// areas, lines and markers, opaque and translucent, chosen or not, of each layer, plus the calls of
  /// SpherePass::draw(), MeshPass::draw(), SolidPass::draw() and IconPass::draw(). Areas of several layers may take
  /// more, as they are drawn from the lowest to the highest. `hiding_radius_m` is the radius of an opaque sphere around
  /// the planet's centre, if there is one and the eye is outside of it. Spheres and markers inside and behind that
  /// sphere are not drawn, because on software GL they would cost as much as visible ones.
  int draw(ObjectPart part, const FrameBlock& frame, Viewport viewport, const DrawState& state,
           ObjectChoice choice = ObjectChoice::all, double hiding_radius_m = 0.0);

 private:
  ObjectPass() = default;
  Status build_programs(DepthMode depth);
  void set_up_arrays();
  void plan_fills();
  [[nodiscard]] int draw_fills(const ObjectDraw& draw) const;
  [[nodiscard]] int draw_lines(const SlotBatch<LineVertex>& lines, const LayerBuffers::Buckets& buffers,
                               const ObjectDraw& draw) const;
  [[nodiscard]] int draw_markers(const DrawnLayer& layer, const ObjectDraw& draw) const;

  /// Fills of one layer that are drawn together.
  struct FillDraw {
    std::size_t layer;
    FillRun run;
  };
  gl::Program fill_, line_, marker_;
  gl::VertexArray fill_array_, line_array_, marker_array_;
  std::unique_ptr<SpherePass> spheres_;
  DepthMode depth_ = DepthMode::reversed;
  std::vector<std::byte> font_;
  std::unique_ptr<LabelPass> labels_;
  std::unique_ptr<MeshPass> meshes_;
  std::unique_ptr<SolidPass> solids_;
  std::unique_ptr<IconPass> icons_;
  std::vector<DrawnLayer> given_, layers_;  ///< those of set_layers(), and those among them that are on the GPU
  std::vector<std::uint64_t> planned_;      ///< LayerBatches::fill_version of each layer in fills_
  std::array<std::vector<FillDraw>, Batch<char>::kBuckets> fills_;  ///< per bucket, lowest first
};

}  // namespace terrella
