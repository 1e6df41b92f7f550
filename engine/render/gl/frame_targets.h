#pragma once

#include <glm/vec2.hpp>

#include "geo/camera.h"
#include "render/gl/gl_handle.h"

namespace terrella {

/// The picture that the passes draw into before it goes to the caller's framebuffer, with its depth and, where a frame
/// needs one, its stencil. thread: main
class FrameTargets {
 public:
  /// Keeps what fits, makes the rest anew.
  void fit(Viewport size, bool with_stencil);
  [[nodiscard]] GLuint framebuffer() const { return framebuffer_.name(); }
  [[nodiscard]] GLuint color() const { return color_.name(); }
  [[nodiscard]] GLuint depth() const { return depth_.name(); }
  [[nodiscard]] Viewport size() const { return size_; }
  [[nodiscard]] bool has_stencil() const { return has_stencil_; }
  /// Room for another picture of the same size, by way of which a pass may write what it reads. What is in it is
  /// anybody's guess.
  struct Beside {
    GLuint framebuffer, texture;
  };
  [[nodiscard]] Beside beside();
  /// The picture goes to a framebuffer, its lower left corner to a place there.
  void copy_to(GLuint framebuffer, glm::ivec2 corner_px) const;

 private:
  gl::Texture color_, depth_, beside_;
  gl::Framebuffer framebuffer_, beside_framebuffer_;
  Viewport size_{0, 0};
  bool has_stencil_ = false;
};

}  // namespace terrella
