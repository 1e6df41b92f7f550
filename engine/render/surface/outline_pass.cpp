#include "render/surface/outline_pass.h"

#include "render/gl/shader_library.h"

namespace terrella {

Result<std::unique_ptr<OutlinePass>> OutlinePass::create() {
  std::unique_ptr<OutlinePass> pass(new OutlinePass);
  if (Status s = build_into(pass->program_,
                            {{GL_VERTEX_SHADER, {"outline.vert"}}, {GL_FRAGMENT_SHADER, {"outline.frag"}}}, {});
      !s)
    return s.error();
  pass->vertex_array_ = gl::make_vertex_array();
  return pass;
}

void OutlinePass::draw(Viewport size, const LimbPicture& picture, const OutlineDepth& depth, DrawState state) const {
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
}

}  // namespace terrella
