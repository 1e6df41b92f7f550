#pragma once

#include <memory>

#include "base/result.h"
#include "geo/camera.h"
#include "render/gl/draw_state.h"
#include "render/gl/frame_targets.h"
#include "render/gl/gl_handle.h"
#include "render/surface/limb_pass.h"

namespace terrella {

/// Depth of the frame, and the depth of nothing.
struct OutlineDepth {
  GLuint texture = 0;
  float nothing = 0.0F;
};

/// Antialiases the outline of the ground against what has no depth, where it is not the limb's curve: of mountains. By
/// the picture alone: shaders/surface/outline.frag. thread: main
class OutlinePass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<OutlinePass>> create();

  /// Blends the outline into the bound framebuffer, without a depth test. Returns the draw calls made.
  int draw(Viewport size, const LimbPicture& picture, const OutlineDepth& depth, DrawState state) const;
  /// The same where the framebuffer that is bound is the picture's own, as LimbPass::draw_in_place().
  int draw_in_place(Viewport size, const LimbPicture& picture, const OutlineDepth& depth, const DrawState& state,
                    const FrameTargets::Beside& beside, GLuint framebuffer) const;

 private:
  OutlinePass() = default;
  gl::Program program_;
  gl::VertexArray vertex_array_;
};

}  // namespace terrella
