#include "render/objects/icon_pass.h"

#include <cstddef>

#include "render/gl/shader_library.h"
#include "render/gl/vertex_attribute.h"

namespace terrella {
namespace {

constexpr GLint kAlphaRangeUniform = 3, kBelowUniform = 4;
constexpr float kOpaqueAlpha = 0.99F, kAnyAlpha = 2.0F;

}  // namespace

Result<std::unique_ptr<IconPass>> IconPass::create(DepthMode depth) {
  std::unique_ptr<IconPass> pass(new IconPass);
  if (Status s = build_into(pass->program_,
                            {{GL_VERTEX_SHADER, {"frame.glsl", "object_common.glsl", "object_icon.vert"}},
                             {GL_FRAGMENT_SHADER, {"frame.glsl", "object_common.glsl", "object_icon.frag"}}},
                            {depth_define(depth)});
      !s)
    return s.error();
  pass->array_ = gl::make_vertex_array();
  const GLuint array = pass->array_.name();
  gl::float_attribute(array, 0, 0, 3, offsetof(IconInstance, high_m));
  gl::float_attribute(array, 1, 0, 3, offsetof(IconInstance, low_m));
  gl::float_attribute(array, 2, 0, 4, offsetof(IconInstance, up));
  gl::float_attribute(array, 3, 0, 2, offsetof(IconInstance, anchor));
  gl::float_attribute(array, 4, 0, 1, offsetof(IconInstance, size_px));
  gl::uint_attribute(array, 5, 0, 1, offsetof(IconInstance, image));
  gl::color_attribute(array, 6, 0, offsetof(IconInstance, color));
  gl::color_attribute(array, 7, 0, offsetof(IconInstance, wash));
  glVertexArrayBindingDivisor(array, 0, 1);
  return pass;
}

int IconPass::draw(const DrawnLayer& layer, const ObjectDraw& draw, Viewport viewport, double hiding_radius_m) const {
  int calls = 0;
  for (const bool opaque : {true, false}) {
    if (draw.opaque && !opaque) continue;
    const auto [first, end] = buckets_of(draw.part, opaque, draw.choice);
    for (std::size_t bucket = first; bucket < end; ++bucket) {
      const std::size_t count = layer.objects->batches().icons.bucket(bucket).items.size();
      if (count == 0) continue;
      if (calls++ == 0) {
        set_object_uniforms(program_, viewport, draw.depth_bias, hiding_radius_m);
        glProgramUniform1f(program_.name(), kBelowUniform, layer.objects->batches().icons_below_px);
        DrawState state = draw.state.with(program_.name());
        state.blend = {GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA};
        apply(state);
        glBindVertexArray(array_.name());
        glBindTextureUnit(0, layer.buffers->icon_atlas.texture());
        glBindTextureUnit(1, layer.buffers->icon_atlas.places());
        glBindSampler(0, 0);
        glBindSampler(1, 0);
      }
      // The opaque pixels of opaque icons come with the opaque objects, their edges with the translucent ones.
      glProgramUniform2f(program_.name(), kAlphaRangeUniform, draw.opaque ? kOpaqueAlpha : 0.0F,
                         draw.opaque || !opaque ? kAnyAlpha : kOpaqueAlpha);
      glVertexArrayVertexBuffer(array_.name(), 0, layer.buffers->icons[bucket].name(), 0, sizeof(IconInstance));
      glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(count));
    }
  }
  return calls;
}

}  // namespace terrella
