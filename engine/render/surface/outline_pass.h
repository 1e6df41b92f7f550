#pragma once

#include <memory>

#include "base/result.h"
#include "geo/camera.h"
#include "render/gl/draw_state.h"
#include "render/gl/gl_handle.h"
#include "render/surface/limb_pass.h"

namespace terrella {

/// The depth texture of the frame, and the depth of the background.
struct OutlineDepth {
  GLuint texture = 0;
  float nothing = 0.0F;
};

/// Antialiases the outline of mountains against the background, where the limb is no smooth curve. It uses only the
/// picture and its depth (shaders/surface/outline.frag). thread: main
class OutlinePass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<OutlinePass>> create();

  /// Blends the outline into the bound framebuffer, without a depth test.
  void draw(Viewport size, const LimbPicture& picture, const OutlineDepth& depth, DrawState state) const;

 private:
  OutlinePass() = default;
  gl::Program program_;
  gl::VertexArray vertex_array_;
};

}  // namespace terrella
