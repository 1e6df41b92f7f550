#pragma once

#include <glm/vec2.hpp>

#include "geo/camera.h"
#include "render/gl_handle.h"

namespace terrella {

/// The picture that the passes draw into before it goes to the caller's framebuffer, with its depth and, where a frame
/// needs one, its stencil. thread: main
class FrameTargets {
 public:
  /// Keeps what fits, makes the rest anew.
  void fit(Viewport size, bool with_stencil);
  [[nodiscard]] GLuint framebuffer() const { return framebuffer_.name(); }
  [[nodiscard]] GLuint color() const { return color_.name(); }
  [[nodiscard]] Viewport size() const { return size_; }
  [[nodiscard]] bool has_stencil() const { return has_stencil_; }
  /// A copy of the picture as it is now, for a pass that reads what it writes.
  [[nodiscard]] GLuint copy_of_color();
  /// The picture goes to a framebuffer, its lower left corner to a place there.
  void copy_to(GLuint framebuffer, glm::ivec2 corner_px) const;

 private:
  gl::Texture color_, depth_, copy_;
  gl::Framebuffer framebuffer_;
  Viewport size_{0, 0};
  bool has_stencil_ = false;
};

}  // namespace terrella
