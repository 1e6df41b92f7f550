#include "render/gl/draw_state.h"

namespace terrella {
namespace {

void switch_to(GLenum name, bool on) { on ? glEnable(name) : glDisable(name); }

void apply_depth(const std::optional<DepthState>& depth) {
  switch_to(GL_DEPTH_TEST, depth.has_value());
  const DepthState set = depth.value_or(DepthState{});
  glDepthFunc(set.test);
  glDepthMask(set.write);
}

void apply_stencil(const std::optional<StencilState>& stencil) {
  switch_to(GL_STENCIL_TEST, stencil.has_value());
  const StencilState set = stencil.value_or(StencilState{.write_mask = ~0U});
  glStencilFunc(GL_EQUAL, static_cast<GLint>(set.reference), set.read_mask);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glStencilMask(set.write_mask);
}

void apply_blend(const std::optional<BlendState>& blend) {
  switch_to(GL_BLEND, blend.has_value());
  const BlendState set = blend.value_or(BlendState{});
  glBlendEquation(set.equation);
  glBlendFuncSeparate(set.from_rgb, set.to_rgb, set.from_alpha, set.to_alpha);
  glBlendColor(0.0F, 0.0F, 0.0F, set.constant_alpha);
}

}  // namespace

void apply(const DrawState& state) {
  glUseProgram(state.program);
  apply_depth(state.depth);
  glDepthRange(state.flat_depth.value_or(0.0), state.flat_depth.value_or(1.0));
  apply_stencil(state.stencil);
  apply_blend(state.blend);
  glColorMask(state.color.red, state.color.green, state.color.blue, state.color.alpha);
  switch_to(GL_CULL_FACE, state.cull.has_value());
  glCullFace(state.cull.value_or(GLenum{GL_BACK}));
  switch_to(GL_SCISSOR_TEST, state.scissor);
  switch_to(GL_PROGRAM_POINT_SIZE, state.program_point_size);
}

}  // namespace terrella
