#include "render/splat_pass.h"

#include <cstdint>
#include <vector>

#include "render/shader_library.h"

namespace terrella {
namespace {

constexpr GLint kSplatViewportUniform = 0;

SplatView splat_view(const FrameBlock& frame, Viewport viewport, double hiding_radius_m) {
  return {.view_from_ecef = glm::mat3(frame.view_from_ecef),
          .eye_high_ecef = glm::vec3(frame.eye_high_ecef),
          .eye_low_ecef = glm::vec3(frame.eye_low_ecef),
          .focal = glm::vec2(frame.clip_scale),
          .sun_ecef = glm::vec3(frame.sun_ecef),
          .lit = frame.sun_ecef.w > 0.0F,
          .viewport = viewport,
          .hiding_radius_m = hiding_radius_m};
}

}  // namespace

Status SplatPass::create(DepthMode depth) {
  auto built = build_program({{GL_VERTEX_SHADER, {"frame.glsl", "object_common.glsl", "object_splat.vert"}},
                              {GL_FRAGMENT_SHADER, {"frame.glsl", "object_common.glsl", "object_splat.frag"}}},
                             {depth_define(depth)});
  if (!built) return built.error();
  program_ = std::move(*built);
  pixel_texture_ = gl::make_texture(GL_TEXTURE_BUFFER);
  GLint most_texels = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most_texels);
  most_blocks_ = static_cast<std::size_t>(most_texels) * sizeof(std::uint32_t) / sizeof(SplatBlock);
  array_ = gl::make_vertex_array();
  glEnableVertexArrayAttrib(array_.name(), 0);
  glVertexArrayAttribIFormat(array_.name(), 0, 4, GL_UNSIGNED_INT, 0);
  glVertexArrayAttribBinding(array_.name(), 0, 0);
  glVertexArrayBindingDivisor(array_.name(), 0, 1);
  return Done{};
}

bool SplatPass::prepare(std::size_t first, std::size_t count, const FrameBlock& frame, Viewport viewport,
                        double hiding_radius_m) {
  const std::size_t blocks = SphereSplats::blocks_of(viewport);
  if (blocks > most_blocks_) return false;
  const std::span<SplatBlock> picture = picture_.begin<SplatBlock>(blocks);
  if (picture.empty()) return false;
  splats_.draw(spheres_, first, count, splat_view(frame, viewport, hiding_radius_m), picture);
  large_.fill(splats_.large().data(), splats_.large().size_bytes());
  return true;
}

int SplatPass::draw(Viewport viewport) {
  const std::vector<SphereSplats::Run> runs = splats_.runs();
  if (runs.empty()) return 0;
  runs_.fill(runs.data(), runs.size() * sizeof(SphereSplats::Run));
  glVertexArrayVertexBuffer(array_.name(), 0, runs_.name(), 0, sizeof(SphereSplats::Run));
  glTextureBuffer(pixel_texture_.name(), GL_R32UI, picture_.name());
  glProgramUniform2f(program_.name(), kSplatViewportUniform, float(viewport.width_px), float(viewport.height_px));
  glUseProgram(program_.name());
  glBindVertexArray(array_.name());
  glBindTextureUnit(0, pixel_texture_.name());
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // two factors are half a millisecond dearer than one, a megapixel
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(runs.size()));
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  picture_.use_ends();
  return 1;
}

}  // namespace terrella
