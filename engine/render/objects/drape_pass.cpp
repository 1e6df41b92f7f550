#include "render/objects/drape_pass.h"

#include <array>
#include <cstddef>

#include "render/gl/shader_library.h"
#include "render/objects/object_common.h"

namespace terrella {
namespace {

constexpr GLint kRangeUniform = 3, kPolarUniform = 4, kPictureUniform = 5;
constexpr GLsizei kPrismVertices = 24, kBoxVertices = 14;
// Any value over 0: the object lies over the ground, and has the air before the ground.
constexpr float kOverGround = 1.0e-4F;

}  // namespace

Result<std::unique_ptr<DrapePass>> DrapePass::create(DepthMode depth, bool samples) {
  std::unique_ptr<DrapePass> pass(new DrapePass);
  pass->samples_ = samples;
  const auto build = [&](gl::Program& program, std::string_view vertex, std::string_view fragment) {
    return build_into(
        program,
        {{GL_VERTEX_SHADER, {"frame.glsl", "object_common.glsl", vertex}},
         {GL_FRAGMENT_SHADER,
          {"frame.glsl", "object_common.glsl", "air_part.glsl", "object_air.glsl", "drape.glsl", fragment}}},
        {depth_define(depth), samples ? "SAMPLES" : "NO_SAMPLES"});
  };
  if (Status s = build(pass->fill_, "drape_fill.vert", "drape_fill.frag"); !s) return s.error();
  if (Status s = build(pass->line_, "drape_line.vert", "drape_line.frag"); !s) return s.error();
  pass->set_up_arrays();
  return pass;
}

void DrapePass::set_up_arrays() {
  fill_array_ = gl::make_vertex_array();
  const GLuint fills = fill_array_.name();
  for (GLuint k = 0; k < 3; ++k) {
    gl::float_attribute(fills, 2 * k, 0, 3, offsetof(DrapeTriangle, high_m) + k * sizeof(glm::vec3));
    gl::float_attribute(fills, 2 * k + 1, 0, 3, offsetof(DrapeTriangle, low_m) + k * sizeof(glm::vec3));
  }
  gl::color_attribute(fills, 6, 0, offsetof(DrapeTriangle, color));
  glVertexArrayBindingDivisor(fills, 0, 1);
  line_array_ = line_pieces_array();
}

int DrapePass::draw(std::span<const DrawnLayer> layers, const GroundPicture& picture, DrawState state) const {
  state.depth.reset();
  state.cull = GL_FRONT;  // the eye may be inside
  state.blend = {GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA};
  for (const gl::Program* program : {&fill_, &line_}) {
    set_object_uniforms(*program, picture.viewport, kOverGround, 0.0);
    glProgramUniform2f(program->name(), kRangeUniform, picture.ground_range_m.x, picture.ground_range_m.y);
    glProgramUniform1f(program->name(), kPolarUniform, static_cast<float>(picture.polar_scale));
    glProgramUniform3i(program->name(), kPictureUniform, picture.at.x, picture.at.y, picture.at.z);
  }
  // The saved state of the caller has no multisampled textures (GlobeRenderer::copy_samples()).
  glActiveTexture(GL_TEXTURE0);
  GLint before = 0;
  if (samples_) glGetIntegerv(GL_TEXTURE_BINDING_2D_MULTISAMPLE, &before);
  glBindTextureUnit(0, picture.depth);
  glBindSampler(0, 0);
  glTextureBarrier();  // the depth was written by the same framebuffer
  int calls = 0;
  for (const DrawnLayer& layer : layers) {
    const auto& triangles = layer.objects->batches().draped_fills.bucket(LayerBatches::kDraped);
    if (triangles.live == 0) continue;
    apply(state.with(fill_.name()));
    glBindVertexArray(fill_array_.name());
    glVertexArrayVertexBuffer(fill_array_.name(), 0, layer.buffers->draped_fills.name(), 0, sizeof(DrapeTriangle));
    glDrawArraysInstanced(GL_TRIANGLES, 0, kPrismVertices, static_cast<GLsizei>(triangles.items.size()));
    ++calls;
  }
  for (const DrawnLayer& layer : layers) {
    const auto& pieces = layer.objects->batches().draped_lines.bucket(LayerBatches::kDraped);
    if (pieces.live == 0 || pieces.items.size() < kVerticesOfAPiece) continue;
    apply(state.with(line_.name()));
    bind_line_pieces(line_array_, layer.buffers->draped_lines.name());
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, kBoxVertices,
                          static_cast<GLsizei>(pieces.items.size() - kVerticesOfAPiece + 1));
    ++calls;
  }
  if (samples_) glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, static_cast<GLuint>(before));
  return calls;
}

}  // namespace terrella
