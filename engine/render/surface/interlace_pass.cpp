#include "render/surface/interlace_pass.h"

#include "render/gl/draw_state.h"
#include "render/gl/shader_library.h"
#include "render/gl/stencil_bits.h"

namespace terrella {

Result<std::unique_ptr<InterlacePass>> InterlacePass::create() {
  std::unique_ptr<InterlacePass> pass(new InterlacePass);
  if (Status s = build_into(pass->program_,
                            {{GL_VERTEX_SHADER, {"interlace.vert"}}, {GL_FRAGMENT_SHADER, {"interlace.frag"}}}, {});
      !s)
    return s.error();
  pass->vertex_array_ = gl::make_vertex_array();
  return pass;
}

int InterlacePass::draw(int height_px) const {
  apply({.program = program_.name(),
         .stencil = StencilState{.reference = kRightEyeBit, .write_mask = kRightEyeBit},
         .color = {false, false, false, false}});
  glUniform1i(0, height_px);
  glBindVertexArray(vertex_array_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  return 1;
}

}  // namespace terrella
