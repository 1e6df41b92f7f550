#pragma once

#include <memory>

#include "base/result.h"
#include "geo/camera.h"
#include "objects/sphere_groups.h"
#include "render/gl/frame_block.h"
#include "render/gl/gl_handle.h"
#include "render/gl/stream_buffer.h"
#include "render/objects/layer_buffers.h"
#include "render/objects/object_common.h"
#include "view/render_modes.h"

namespace terrella {

/// Draws spheres. Groups outside the picture are culled. Small spheres are points, all others are triangles around
/// their outlines. Both look the same. thread: main
class SpherePass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<SpherePass>> create(DepthMode depth);

  /// As ObjectPass::draw(), for one layer. Returns the draw calls made: at most one for triangles and one for points.
  int draw(const DrawnLayer& layer, const ObjectDraw& draw, const FrameBlock& frame, Viewport viewport,
           double hiding_radius_m);

 private:
  SpherePass() = default;
  void draw_triangles(const std::vector<SphereGroups::Run>& runs, const DrawState& state);
  void draw_points(const std::vector<SphereGroups::Run>& runs, DrawState state) const;

  gl::Program triangle_, point_;
  gl::VertexArray triangle_array_, point_array_;
  StreamBuffer commands_;
  float largest_point_px_ = 0.0F;
};

}  // namespace terrella
