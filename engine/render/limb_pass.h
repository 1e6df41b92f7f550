#pragma once

#include <memory>

#include "geo/camera.h"
#include "geo/result.h"
#include "render/gl_handle.h"

namespace terrella {

/// Antialiases the globe's limb in a finished picture; shaders/limb.frag. thread: main
class LimbPass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<LimbPass>> create();

  /// Blends the limb of `picture` (the frame without it, at pixel (0, 0)) into the framebuffer that is bound.
  /// Returns the draw calls made: 0 where no limb is in view, else 1.
  int draw(const View& view, const Ellipsoid& ellipsoid, GLuint picture);

 private:
  LimbPass() = default;
  gl::Program program_;
  gl::VertexArray vertex_array_;
  gl::Buffer vertices_;
};

}  // namespace terrella
