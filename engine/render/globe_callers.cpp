#include "render/caller_glsl.h"
#include "render/gl/gl_state.h"
#include "render/gl/shader_library.h"
#include "render/gl/stencil_bits.h"
#include "render/globe_renderer.h"

// Drawing of the application's own in a frame.
namespace terrella {

std::string caller_glsl(DepthMode depth) {
  return "#define " + std::string(depth_define(depth)) + "\n" + shader_text("caller.glsl").value_or("");
}

// The caller begins with the state of the frame's own passes, and may leave any state.
void GlobeRenderer::draw_callers(const Pass& pass, DrawStage stage) {
  if (!*pass.input.on_draw) return;
  const View& view = pass.eye.view;
  const GlState kept;
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glBindFramebuffer(GL_FRAMEBUFFER, targets_->framebuffer());
  glViewport(pass.eye.left_px, 0, view.viewport.width_px, view.viewport.height_px);
  glScissor(pass.eye.left_px, 0, view.viewport.width_px, view.viewport.height_px);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block_.name());
  glBindVertexArray(0);  // a caller that binds none must not change a pass's
  for (GLuint unit = 0; unit < GlState::kUnits; ++unit) glBindSampler(unit, 0);  // the caller's textures filter
  glActiveTexture(GL_TEXTURE0);
  DrawState state = picture_state(pass.eye);
  // No sky is drawn over the caller's pixels.
  state.stencil = stencil(pass.eye, {.set = stage == DrawStage::all ? 0 : kSurfaceBit});
  apply(state);
  FrameMatrices matrices = frame_matrices(view, frame_.clip_scale.z, frame_.clip_scale.w, options_.depth);
  matrices.corner_px = {pass.eye.left_px, 0};
  (*pass.input.on_draw)(stage, matrices);
}

}  // namespace terrella
