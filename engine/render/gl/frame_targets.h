#pragma once

#include <glm/vec2.hpp>

#include "geo/camera.h"
#include "render/gl/gl_handle.h"

namespace terrella {

/// The picture into which the passes draw before it is copied to the caller's framebuffer. It has depth and, if a frame
/// needs it, stencil. thread: main
class FrameTargets {
 public:
  /// Makes the textures for this size. Keeps those that already fit.
  void fit(Viewport size, bool with_stencil);
  [[nodiscard]] GLuint framebuffer() const { return framebuffer_.name(); }
  [[nodiscard]] GLuint color() const { return color_.name(); }
  [[nodiscard]] GLuint depth() const { return depth_.name(); }
  [[nodiscard]] Viewport size() const { return size_; }
  [[nodiscard]] bool has_stencil() const { return has_stencil_; }
  /// Returns a second picture of the same size, for passes that read and write the picture. Its content is undefined.
  struct Beside {
    GLuint framebuffer, texture;
  };
  [[nodiscard]] Beside beside();
  /// Copies the picture to a framebuffer, with its lower left corner at `corner_px`.
  void copy_to(GLuint framebuffer, glm::ivec2 corner_px) const;

 private:
  gl::Texture color_, depth_, beside_;
  gl::Framebuffer framebuffer_, beside_framebuffer_;
  Viewport size_{0, 0};
  bool has_stencil_ = false;
};

}  // namespace terrella
