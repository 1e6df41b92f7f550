#pragma once

#include <memory>

#include "base/result.h"
#include "render/gl/gl_handle.h"

namespace terrella {

/// Marks the right eye's rows in the stencil buffer (stencil_bits.h), for interlaced stereo. thread: main
class InterlacePass {
 public:
  [[nodiscard]] static Result<std::unique_ptr<InterlacePass>> create();

  /// Draws into the bound framebuffer. Returns the draw calls made.
  int draw(int height_px) const;

 private:
  InterlacePass() = default;
  gl::Program program_;
  gl::VertexArray vertex_array_;
};

}  // namespace terrella
