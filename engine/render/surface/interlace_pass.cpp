#include "render/surface/interlace_pass.h"

#include "render/gl/shader_library.h"
#include "render/gl/stencil_bits.h"

namespace terrella {

Result<std::unique_ptr<InterlacePass>> InterlacePass::create() {
  Result<gl::Program> program =
      build_program({{GL_VERTEX_SHADER, {"interlace.vert"}}, {GL_FRAGMENT_SHADER, {"interlace.frag"}}}, {});
  if (!program) return program.error();
  std::unique_ptr<InterlacePass> pass(new InterlacePass);
  pass->program_ = std::move(*program);
  pass->vertex_array_ = gl::make_vertex_array();
  return pass;
}

int InterlacePass::draw(int height_px) const {
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_STENCIL_TEST);
  glStencilMask(kRightEyeBit);
  glStencilFunc(GL_ALWAYS, static_cast<GLint>(kRightEyeBit), kRightEyeBit);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glUseProgram(program_.name());
  glUniform1i(0, height_px);
  glBindVertexArray(vertex_array_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  return 1;
}

}  // namespace terrella
