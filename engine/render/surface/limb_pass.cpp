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
  std::unique_ptr<LimbPass> pass(new LimbPass);
  if (Status s =
          build_into(pass->program_, {{GL_VERTEX_SHADER, {"limb.vert"}}, {GL_FRAGMENT_SHADER, {"limb.frag"}}}, {});
      !s)
    return s.error();
  pass->vertex_array_ = gl::make_vertex_array();
  pass->vertices_ = gl::make_buffer();
  const GLuint array = pass->vertex_array_.name();
  glVertexArrayVertexBuffer(array, 0, pass->vertices_.name(), 0, sizeof(LimbVertex));
  gl::float_attribute(array, 0, 0, 2, offsetof(LimbVertex, position_ndc));
  gl::float_attribute(array, 1, 0, 2, offsetof(LimbVertex, outward_px));
  gl::float_attribute(array, 2, 0, 1, offsetof(LimbVertex, distance_px));
  return pass;
}

bool LimbPass::fit(const View& view, const Ellipsoid& ellipsoid) {
  const std::vector<LimbVertex> strip = limb_ribbon(view, ellipsoid, kHalfWidth_px);
  count_ = static_cast<GLsizei>(strip.size());
  if (strip.empty()) return false;
  glNamedBufferData(vertices_.name(), static_cast<GLsizeiptr>(strip.size() * sizeof(LimbVertex)), strip.data(),
                    GL_STREAM_DRAW);
  return true;
}

void LimbPass::draw(Viewport size, const LimbPicture& picture, DrawState state) const {
  state.depth.reset();
  state.cull.reset();
  apply(state.with(program_.name()));
  glUniform1i(0, picture.rows_apart);
  glUniform4i(1, picture.left_px, 0, picture.left_px + size.width_px - 1, size.height_px - 1);
  glBindTextureUnit(0, picture.texture);
  glBindSampler(0, 0);
  glBindVertexArray(vertex_array_.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, count_);
}

}  // namespace terrella
