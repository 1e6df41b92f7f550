#include "render/surface/limb_pass.h"

#include <cstddef>

#include "render/gl/shader_library.h"
#include "render/gl/vertex_attribute.h"
#include "surface/limb.h"

namespace terrella {
namespace {
// Half a pixel of coverage to either side, plus the error of the mesh.
constexpr double kHalfWidth_px = 1.0;
}  // namespace

Result<std::unique_ptr<LimbPass>> LimbPass::create() {
  Result<gl::Program> program =
      build_program({{GL_VERTEX_SHADER, {"limb.vert"}}, {GL_FRAGMENT_SHADER, {"limb.frag"}}}, {});
  if (!program) return program.error();
  std::unique_ptr<LimbPass> pass(new LimbPass);
  pass->program_ = std::move(*program);
  pass->vertex_array_ = gl::make_vertex_array();
  pass->vertices_ = gl::make_buffer();
  const GLuint array = pass->vertex_array_.name();
  glVertexArrayVertexBuffer(array, 0, pass->vertices_.name(), 0, sizeof(LimbVertex));
  gl::float_attribute(array, 0, 0, 2, offsetof(LimbVertex, position_ndc));
  gl::float_attribute(array, 1, 0, 2, offsetof(LimbVertex, outward_px));
  gl::float_attribute(array, 2, 0, 1, offsetof(LimbVertex, distance_px));
  return pass;
}

GLsizei LimbPass::upload(const View& view, const Ellipsoid& ellipsoid) const {
  const std::vector<LimbVertex> strip = limb_ribbon(view, ellipsoid, kHalfWidth_px);
  if (strip.empty()) return 0;
  glNamedBufferData(vertices_.name(), static_cast<GLsizeiptr>(strip.size() * sizeof(LimbVertex)), strip.data(),
                    GL_STREAM_DRAW);
  return static_cast<GLsizei>(strip.size());
}

void LimbPass::draw_ribbon(GLsizei vertices, const View& view, const LimbPicture& picture, DrawState state) const {
  state.depth.reset();
  state.cull.reset();
  apply(state.with(program_.name()));
  glUniform1i(0, picture.rows_apart);
  glUniform4i(1, picture.left_px, 0, picture.left_px + view.viewport.width_px - 1, view.viewport.height_px - 1);
  glBindTextureUnit(0, picture.texture);
  glBindSampler(0, 0);
  glBindVertexArray(vertex_array_.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, vertices);
}

int LimbPass::draw(const View& view, const Ellipsoid& ellipsoid, const LimbPicture& picture, const DrawState& state) {
  const GLsizei vertices = upload(view, ellipsoid);
  if (vertices == 0) return 0;
  draw_ribbon(vertices, view, picture, state);
  return 1;
}

int LimbPass::draw_in_place(const View& view, const Ellipsoid& ellipsoid, const LimbPicture& picture,
                            const DrawState& state, const FrameTargets::Beside& beside, GLuint framebuffer) {
  const GLsizei vertices = upload(view, ellipsoid);
  if (vertices == 0) return 0;
  glBindFramebuffer(GL_FRAMEBUFFER, beside.framebuffer);
  draw_ribbon(vertices, view, picture, state);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  draw_ribbon(vertices, view, {.texture = beside.texture, .rows_apart = 0}, state);
  return 2;
}

}  // namespace terrella
