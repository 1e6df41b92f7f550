#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "geo/camera.h"
#include "objects/object_batches.h"
#include "render/gl/draw_state.h"
#include "render/gl/gl_handle.h"
#include "render/gl/shader_library.h"
#include "render/gl/vertex_attribute.h"

namespace terrella {

/// One part of the objects, as one pass draws it.
struct ObjectDraw {
  ObjectPart part;
  bool opaque;
  ObjectChoice choice;
  float depth_bias;
  DrawState state;  ///< state of ObjectPass::draw() with blending, and depth writes only if `opaque`
};

// Functions that the object passes share; the uniforms are those of shaders/objects/object_common.glsl. thread: main

/// Builds a program of objects with air before them.
inline Status build_object_program(gl::Program& program, std::string_view vertex, std::string_view fragment,
                                   DepthMode depth) {
  return build_into(
      program,
      {{GL_VERTEX_SHADER, {"frame.glsl", "object_common.glsl", "air_part.glsl", "object_air.glsl", vertex}},
       {GL_FRAGMENT_SHADER, {"frame.glsl", "object_common.glsl", "air_part.glsl", "object_air.glsl", fragment}}},
      {depth_define(depth)});
}

inline void set_object_uniforms(const gl::Program& program, Viewport viewport, float bias, double hiding_radius_m) {
  constexpr GLint kViewport = 0, kBias = 1, kHiding = 2;
  glProgramUniform2f(program.name(), kViewport, float(viewport.width_px), float(viewport.height_px));
  glProgramUniform1f(program.name(), kBias, bias);
  glProgramUniform1f(program.name(), kHiding, static_cast<float>(hiding_radius_m));
}

/// Makes a vertex array that reads DotInstance from the buffer at binding 0: one per `divisor` instances, or one per
/// vertex if `divisor` is 0.
inline gl::VertexArray dot_array(GLuint divisor) {
  gl::VertexArray array = gl::make_vertex_array();
  gl::float_attribute(array.name(), 0, 0, 3, offsetof(DotInstance, high_m));
  gl::float_attribute(array.name(), 1, 0, 3, offsetof(DotInstance, low_m));
  gl::float_attribute(array.name(), 2, 0, 1, offsetof(DotInstance, size));
  gl::color_attribute(array.name(), 3, 0, offsetof(DotInstance, color));
  glVertexArrayBindingDivisor(array.name(), 0, divisor);
  return array;
}

inline constexpr std::size_t kVerticesOfAPiece = 4;  ///< the previous vertex, this one, the next, the one after that

/// Makes a vertex array that reads a piece of a line per instance: four LineVertex.
inline gl::VertexArray line_pieces_array() {
  gl::VertexArray array = gl::make_vertex_array();
  for (GLuint k = 0; k < kVerticesOfAPiece; ++k) {
    gl::float_attribute(array.name(), 2 * k, k, 3, offsetof(LineVertex, high_m));
    gl::float_attribute(array.name(), 2 * k + 1, k, 3, offsetof(LineVertex, low_m));
    glVertexArrayBindingDivisor(array.name(), k, 1);
  }
  gl::float_attribute(array.name(), 8, 1, 1, offsetof(LineVertex, width_px));
  gl::color_attribute(array.name(), 9, 1, offsetof(LineVertex, color));
  gl::float_attribute(array.name(), 10, 1, 2, offsetof(LineVertex, along_m));
  gl::short_attribute(array.name(), 11, 1, 2, offsetof(LineVertex, on));
  return array;
}

/// Binds it with a buffer of LineVertex.
inline void bind_line_pieces(const gl::VertexArray& array, GLuint buffer) {
  glBindVertexArray(array.name());
  for (GLuint k = 0; k < kVerticesOfAPiece; ++k) {
    glVertexArrayVertexBuffer(array.name(), k, buffer, static_cast<GLintptr>(k * sizeof(LineVertex)),
                              sizeof(LineVertex));
  }
}

/// Makes a buffer with these elements; no buffer if there are none.
template <class T>
gl::Buffer buffer_of(const std::vector<T>& items) {
  if (items.empty()) return {};
  gl::Buffer buffer = gl::make_buffer();
  glNamedBufferStorage(buffer.name(), static_cast<GLsizeiptr>(items.size() * sizeof(T)), items.data(), 0);
  return buffer;
}

}  // namespace terrella
