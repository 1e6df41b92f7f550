#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>

#include "base/result.h"
#include "geo/camera.h"
#include "render/gl/gl_handle.h"

namespace terrella {

/// The picture into which the passes draw before it is copied to the caller's framebuffer. It has depth and, if a frame
/// needs it, stencil. With samples, color() and depth() are textures of one value a pixel beside the picture itself;
/// resolve_color() and resolve_depth() fill them. thread: main
class FrameTargets {
 public:
  struct Form {
    Viewport size{0, 0};
    bool has_stencil = false;
    int samples = 0;  ///< samples per pixel; 0: the picture is not multisampled
    bool operator==(const Form&) const = default;
  };
  /// Longest side of a picture that the driver draws, pixels.
  [[nodiscard]] static int longest_side_px();
  /// Makes the textures for this form. Keeps those that already fit. Fails if the driver has no memory
  /// for it.
  [[nodiscard]] Status fit(const Form& form);
  [[nodiscard]] GLuint framebuffer() const { return framebuffer_.name(); }
  [[nodiscard]] GLuint color() const { return color_.name(); }
  [[nodiscard]] GLuint depth() const { return depth_.name(); }
  [[nodiscard]] GLuint color_samples() const { return color_samples_.name(); }
  [[nodiscard]] GLuint depth_samples() const { return depth_samples_.name(); }
  [[nodiscard]] const Form& form() const { return form_; }
  /// Number of the frame whose picture this is; 0: none.
  [[nodiscard]] std::uint64_t frame() const { return frame_; }
  void set_frame(std::uint64_t frame) { frame_ = frame; }
  [[nodiscard]] Viewport size() const { return form_.size; }
  [[nodiscard]] bool has_stencil() const { return form_.has_stencil; }
  [[nodiscard]] int samples() const { return form_.samples; }
  /// Returns one of two more pictures of the same size, for passes that read and write the picture. Its content is
  /// undefined. Its texture is 0 if the driver has no memory for it.
  struct Beside {
    GLuint framebuffer = 0, texture = 0;
  };
  [[nodiscard]] Beside beside(std::size_t which = 0);
  /// Copies the means of the samples to color() and to a picture beside it. Does nothing without samples.
  void resolve_color(const Beside& beside) const;
  void resolve_depth() const;  ///< copies one sample of each pixel to depth(); does nothing without samples
  /// Copies a picture to a framebuffer without samples, with its lower left corner at `corner_px`.
  void copy_to(GLuint framebuffer, glm::ivec2 corner_px) const;

 private:
  void resolve(GLbitfield what, GLuint into) const;
  [[nodiscard]] bool has_memory() const;

  gl::Texture color_, depth_, color_samples_, depth_samples_;
  std::array<gl::Texture, 2> beside_;
  gl::Framebuffer framebuffer_, resolved_;
  std::array<gl::Framebuffer, 2> beside_framebuffer_;
  Form form_;
  std::uint64_t frame_ = 0;
};

}  // namespace terrella
