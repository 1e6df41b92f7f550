#pragma once

#include <memory>

#include "base/result.h"
#include "geo/camera.h"
#include "objects/object_batches.h"
#include "render/gl/frame_block.h"
#include "render/gl/gl_handle.h"
#include "render/objects/label_pass.h"
#include "render/objects/mesh_pass.h"
#include "render/objects/sphere_pass.h"
#include "view/render_modes.h"

namespace terrella {

/// Draws the objects of a scene: areas, spheres, meshes, lines, markers. All positions are relative to the eye.
/// thread: main
class ObjectPass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<ObjectPass>> create(DepthMode depth);

  /// Uploads a scene, which replaces the previous one.
  void set_objects(const ObjectBatches& batches);
  void set_objects(const ObjectScene& scene, const Ellipsoid& ellipsoid) {
    set_objects(make_batches(scene, ellipsoid));
  }
  [[nodiscard]] bool has(ObjectPart part) const;

  /// Sets the font of labels, the bytes of a font file. Without a font, no labels are drawn.
  void set_label_font(std::vector<std::byte> font) { font_ = std::move(font); }
  /// Replaces all labels. The first call builds the program for labels.
  Status set_labels(const std::vector<LabelObject>& labels, const Ellipsoid& ellipsoid);
  /// Replaces all meshes. The first call builds the program for meshes.
  Status set_meshes(const std::vector<MeshObject>& meshes, const Ellipsoid& ellipsoid);
  /// Chooses the labels of a frame. Before the first call, no labels are drawn.
  void place_labels(const View& view, const LabelSight& sight) {
    if (labels_) labels_->place(view, sight);
  }

  /// Draws one part into the bound framebuffer with the depth test, stencil and color mask of `state`. The caller has
  /// set the viewport (its size is `viewport`) and the frame's uniform block (binding 0; `frame` is its content).
  /// Opaque objects write depth. Translucent ones come after them and do not. Objects over or on the ground are drawn a
  /// little towards the eye, objects under the ground are not. Returns the draw calls made: at most one for each of
  /// areas, lines and markers, opaque and translucent, plus the calls of SpherePass::draw() and MeshPass::draw().
  /// `hiding_radius_m` is the radius of an opaque sphere around the planet's centre, if there is one and the eye is
  /// outside of it. Spheres and markers inside and behind that sphere are not drawn, because on software GL they would
  /// cost as much as visible ones.
  int draw(ObjectPart part, const FrameBlock& frame, Viewport viewport, const DrawState& state,
           ObjectChoice choice = ObjectChoice::all, double hiding_radius_m = 0.0);

 private:
  ObjectPass() = default;
  Status build_programs(DepthMode depth);
  void set_up_arrays();
  [[nodiscard]] int draw_fills(const ObjectDraw& draw) const;
  [[nodiscard]] int draw_lines(const ObjectDraw& draw) const;
  [[nodiscard]] int draw_markers(const ObjectDraw& draw) const;

  /// A batch without its elements, which are on the GPU.
  using Ranges = Batch<char>;
  gl::Program fill_, line_, marker_;
  gl::VertexArray fill_array_, line_array_, marker_array_;
  gl::Buffer fill_vertices_, fill_indices_, lines_, markers_;
  std::unique_ptr<SpherePass> spheres_;
  DepthMode depth_ = DepthMode::reversed;
  std::vector<std::byte> font_;
  std::unique_ptr<LabelPass> labels_;
  std::unique_ptr<MeshPass> meshes_;
  bool has_labels_above_ = false, has_labels_underground_ = false;
  Ranges fill_ranges_, line_ranges_, marker_ranges_;
};

}  // namespace terrella
