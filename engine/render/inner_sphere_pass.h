#pragma once

#include <memory>

#include "geo/result.h"
#include "render/gl_handle.h"
#include "scene/render_modes.h"

namespace terrella {

/// The sphere of the background's colour under a translucent surface (paper 2, 2.1). The caller has bound the
/// framebuffer and the frame's uniform block and set depth and stencil. thread: main
class InnerSpherePass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<InnerSpherePass>> create(DepthMode depth);

  /// Returns the draw calls made.
  int draw(double radius_m) const;

 private:
  InnerSpherePass() = default;
  gl::Program program_;
  gl::VertexArray vertex_array_;
  gl::Buffer vertices_, indices_;
  GLsizei count_ = 0;
};

/// Radius of the inner sphere: so far under the equator, in metres of Earth, scaled to the body and at most 0.98 of its
/// shortest axis. Source: paper 2, 2.1, where it is the equator's radius - 1000 km. thread: any
[[nodiscard]] double inner_sphere_radius_m(double a_m, double b_m, double below_m);

}  // namespace terrella
