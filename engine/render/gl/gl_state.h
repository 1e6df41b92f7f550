#pragma once

#include <epoxy/gl.h>

#include <array>
#include <vector>

namespace terrella {

/// Sets the state on which drawing a globe depends, and which its passes do not set, to OpenGL's initial values.
/// thread: main (of the context)
void set_first_gl_state();

/// Saves the part of a context's state that drawing a globe changes or depends on. The constructor saves this state and
/// calls set_first_gl_state(). The destructor restores the state. Queries, transform feedback and conditional rendering
/// are not saved, so none of them may be active. thread: main (of the context)
class GlState {
 public:
  static constexpr GLuint kUnits = 16;  ///< number of texture units that passes use
  GlState();
  ~GlState();
  GlState(const GlState&) = delete;
  GlState& operator=(const GlState&) = delete;

 private:
  static constexpr std::size_t kTargets = 4;
  static constexpr std::size_t kStores = 16;

  struct Switch {
    GLenum name;
    bool on;
  };
  /// Blending state of one draw buffer.
  struct Blending {
    bool on;
    GLint from_rgb, to_rgb, from_alpha, to_alpha, equation_rgb, equation_alpha;
    std::array<GLboolean, 4> mask;
  };
  struct StencilFace {
    GLint test, reference, read_mask, write_mask, fail, depth_fail, pass;
  };
  /// State of one viewport.
  struct Window {
    std::array<GLfloat, 4> viewport;
    std::array<GLdouble, 2> depth_range;
    std::array<GLint, 4> scissor;
    bool scissor_on;
  };

  void take_bindings();
  void take_switches();
  void take_fragments();
  void take_windows();
  void take_pixel_stores();
  void put_bindings() const;
  void put_fragments() const;
  void put_windows() const;

  GLint program_ = 0, vertex_array_ = 0, draw_framebuffer_ = 0, read_framebuffer_ = 0, active_unit_ = 0;
  GLint uniform_buffer_ = 0, block_buffer_ = 0, indirect_buffer_ = 0, unpack_buffer_ = 0, pack_buffer_ = 0;
  GLint64 block_first_ = 0, block_bytes_ = 0;
  std::array<std::array<GLint, kTargets>, kUnits> textures_{};
  std::array<GLint, kUnits> samplers_{};
  std::vector<Switch> switches_;
  std::vector<Blending> blending_;
  std::array<StencilFace, 2> stencil_{};
  std::vector<Window> windows_;
  std::array<GLfloat, 4> blend_color_{}, clear_color_{};
  GLint clear_stencil_ = 0, depth_test_ = 0, cull_face_ = 0, front_face_ = 0, polygon_mode_ = 0, clip_origin_ = 0,
        clip_depth_ = 0, provoking_vertex_ = 0, point_origin_ = 0;
  GLdouble clear_depth_ = 0.0;
  GLboolean depth_mask_ = GL_TRUE;
  std::array<GLint, kStores> pixel_stores_{};
};

}  // namespace terrella
