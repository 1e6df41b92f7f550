#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "base/result.h"
#include "render/gl/gl_handle.h"
#include "view/render_modes.h"

namespace terrella {

/// Draws the shapes that hide the far side under a translucent surface, in the background's colour: the inner sphere
/// (paper 2, 2.1), and beside it the curtain of surface/far_side_curtain.h. The caller binds the framebuffer and the
/// frame's uniform block, and sets depth and stencil. thread: main
class InnerSpherePass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<InnerSpherePass>> create(DepthMode depth);

  /// Draws the sphere. Returns the number of draw calls.
  int draw(double radius_m) const;
  int draw_curtain(const std::vector<glm::vec3>& strip) const;  ///< face culling must be off

 private:
  InnerSpherePass() = default;
  gl::Program program_;
  gl::VertexArray vertex_array_, curtain_array_;
  gl::Buffer vertices_, indices_, curtain_;
  GLsizei count_ = 0;
};

}  // namespace terrella
