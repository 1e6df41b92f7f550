#include "render/objects/solid_pass.h"

#include <cstddef>

#include "render/gl/vertex_attribute.h"

namespace terrella {
namespace {

constexpr GLint kSolidBiasUniform = 1;

}  // namespace

Result<std::unique_ptr<SolidPass>> SolidPass::create(DepthMode depth) {
  std::unique_ptr<SolidPass> pass(new SolidPass);
  if (Status s = build_object_program(pass->program_, "object_solid.vert", "object_solid.frag", depth); !s)
    return s.error();
  pass->array_ = gl::make_vertex_array();
  const GLuint array = pass->array_.name();
  gl::float_attribute(array, 0, 0, 3, offsetof(SolidVertex, high_m));
  gl::float_attribute(array, 1, 0, 3, offsetof(SolidVertex, low_m));
  gl::float_attribute(array, 2, 0, 3, offsetof(SolidVertex, normal));
  gl::color_attribute(array, 3, 0, offsetof(SolidVertex, color));
  return pass;
}

bool SolidPass::is_needed(const DrawnLayer& layer) {
  const auto& solids = layer.objects->batches().solids;
  return solids.has(ObjectPart::above_ground) || solids.has(ObjectPart::underground);
}

int SolidPass::draw(const DrawnLayer& layer, const ObjectDraw& draw) const {
  glProgramUniform1f(program_.name(), kSolidBiasUniform, draw.depth_bias);
  DrawState state = draw.state.with(program_.name());
  int calls = 0;
  const auto [first, end] = buckets_of(draw.part, draw.opaque, draw.choice);
  for (std::size_t bucket = first; bucket < end; ++bucket) {
    const std::size_t count = layer.objects->batches().solids.bucket(bucket).items.size();
    if (count == 0) continue;
    glBindVertexArray(array_.name());
    glVertexArrayVertexBuffer(array_.name(), 0, layer.buffers->solids[bucket].name(), 0, sizeof(SolidVertex));
    const auto draw_sides = [&](std::optional<GLenum> left_out) {
      state.cull = left_out;
      apply(state);
      glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(count));
      ++calls;
    };
    if (draw.opaque) {
      draw_sides({});
    } else {
      // For convex areas this is back to front.
      draw_sides(GL_FRONT);
      draw_sides(GL_BACK);
    }
  }
  return calls;
}

}  // namespace terrella
