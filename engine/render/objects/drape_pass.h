#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "base/result.h"
#include "geo/camera.h"
#include "render/gl/draw_state.h"
#include "render/gl/gl_handle.h"
#include "render/objects/layer_buffers.h"
#include "view/render_modes.h"

namespace terrella {

/// A picture with the ground, on which lines and areas are to be laid.
struct GroundPicture {
  Viewport viewport;
  glm::ivec3 at{0, 0, 1};         ///< its lower left corner in `depth`, pixels; rows of the same eye apart
  GLuint depth = 0;               ///< texture of the framebuffer's depth, with samples if the pass has them
  glm::vec2 ground_range_m{0.0};  ///< no ground is lower or higher
  double polar_scale = 1.0;       ///< square of the equatorial over the polar radius
};

/// Lays lines and areas on the ground: draws a box or prism around each piece, and colours its pixels whose ground, by
/// the depth of the picture, lies in the line or area. thread: main
class DrapePass {
 public:
  /// `samples`: the pictures are multisampled.
  [[nodiscard]] static Result<std::unique_ptr<DrapePass>> create(DepthMode depth, bool samples);
  [[nodiscard]] bool has_samples() const { return samples_; }
  /// Draws with the stencil and the colour mask of `state`. First the areas of all layers, then the lines. The
  /// picture's framebuffer is bound. Depth is neither tested nor written, because it is read. Returns the draw calls.
  int draw(std::span<const DrawnLayer> layers, const GroundPicture& picture, DrawState state) const;

 private:
  DrapePass() = default;
  void set_up_arrays();
  bool samples_ = false;
  gl::Program fill_, line_;
  gl::VertexArray fill_array_, line_array_;
};

}  // namespace terrella
