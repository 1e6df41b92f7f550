#include "render/surface/outline_pass.h"

#include <array>

#include "render/gl/shader_library.h"

namespace terrella {

Result<std::unique_ptr<OutlinePass>> OutlinePass::create() {
  Result<gl::Program> program =
      build_program({{GL_VERTEX_SHADER, {"outline.vert"}}, {GL_FRAGMENT_SHADER, {"outline.frag"}}}, {});
  if (!program) return program.error();
  std::unique_ptr<OutlinePass> pass(new OutlinePass);
  pass->program_ = std::move(*program);
  pass->vertex_array_ = gl::make_vertex_array();
  return pass;
}

int OutlinePass::draw(Viewport size, const LimbPicture& picture, const OutlineDepth& depth, DrawState state) const {
  state.depth.reset();
  state.cull.reset();
  apply(state.with(program_.name()));
  glUniform1i(0, picture.rows_apart);
  glUniform4i(1, picture.left_px, 0, picture.left_px + size.width_px - 1, size.height_px - 1);
  glUniform1f(2, depth.nothing);
  glBindTextureUnit(0, picture.texture);
  glBindTextureUnit(1, depth.texture);
  glBindSampler(0, 0);
  glBindSampler(1, 0);
  glBindVertexArray(vertex_array_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  return 1;
}

int OutlinePass::draw_in_place(Viewport size, const LimbPicture& picture, const OutlineDepth& depth,
                               const DrawState& state, const FrameTargets::Beside& beside, GLuint framebuffer) const {
  glBindFramebuffer(GL_FRAMEBUFFER, beside.framebuffer);
  constexpr std::array<float, 4> kNothing{};
  apply(state);
  glClearBufferfv(GL_COLOR, 0, kNothing.data());
  const int calls = draw(size, picture, depth, state);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  return calls + draw(size, {.texture = beside.texture, .left_px = picture.left_px, .rows_apart = 0},
                      {0, depth.nothing}, state);
}

}  // namespace terrella
