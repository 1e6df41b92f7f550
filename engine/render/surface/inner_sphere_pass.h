#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "base/result.h"
#include "render/gl/draw_state.h"
#include "render/gl/gl_handle.h"
#include "view/render_modes.h"

// Paper 2: "Interactive visualization of 3D data on a virtual globe in stereoscopic systems", abstract of a
// dissertation, chapter 2.2.

namespace terrella {

/// Draws the inner sphere, which hides the far side under a translucent surface (paper 2, section 2.1), and the curtain
/// beside it (surface/far_side_curtain.h). Both have the colour of SurfaceLook, by default the background's. The caller
/// has bound the framebuffer and the frame's uniform block. thread: main
class InnerSpherePass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<InnerSpherePass>> create(DepthMode depth);

  /// Returns the draw calls made.
  int draw(double radius_m, const glm::vec3& color_srgb, const DrawState& state) const;
  /// Draws both faces; ignores DrawState::cull.
  int draw_curtain(const std::vector<glm::vec3>& strip, const glm::vec3& color_srgb, DrawState state) const;

 private:
  InnerSpherePass() = default;
  gl::Program program_;
  gl::VertexArray vertex_array_, curtain_array_;
  gl::Buffer vertices_, indices_, curtain_;
  GLsizei count_ = 0;
};

}  // namespace terrella
