#pragma once

#include <memory>

#include "base/result.h"
#include "geo/camera.h"
#include "render/gl/frame_targets.h"
#include "render/gl/gl_handle.h"
#include "render/surface/limb_pass.h"

namespace terrella {

/// Antialiases the outline of the ground, mountains for example, against pixels without depth where LimbPass does not.
/// Uses only the picture: shaders/surface/outline.frag. thread: main
class OutlinePass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<OutlinePass>> create();

  /// Blends the outline into the bound framebuffer, without a depth test. `no_depth` is the depth of empty pixels.
  /// Returns the number of draw calls.
  int draw(Viewport size, const LimbPicture& picture, GLuint depth_texture, float no_depth) const;
  /// The same if the bound framebuffer contains the picture itself, as LimbPass::draw_in_place().
  int draw_in_place(Viewport size, const LimbPicture& picture, GLuint depth_texture, float no_depth,
                    const FrameTargets::Beside& beside, GLuint framebuffer) const;

 private:
  OutlinePass() = default;
  gl::Program program_;
  gl::VertexArray vertex_array_;
};

}  // namespace terrella
