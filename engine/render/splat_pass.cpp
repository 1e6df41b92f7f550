#include "render/splat_pass.h"

#include <cstdint>
#include <vector>

#include "render/shader_library.h"

namespace terrella {
namespace {

constexpr GLint kSplatViewportUniform = 0;

/// Blocks side by side, as object_splat.vert has them.
struct RunInstance {
  std::uint32_t column, row, blocks, first_block;
};

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
  array_ = gl::make_vertex_array();
  glEnableVertexArrayAttrib(array_.name(), 0);
  glVertexArrayAttribIFormat(array_.name(), 0, 4, GL_UNSIGNED_INT, 0);
  glVertexArrayAttribBinding(array_.name(), 0, 0);
  glVertexArrayBindingDivisor(array_.name(), 0, 1);
  return Done{};
}

void SplatPass::prepare(std::size_t first, std::size_t count, const FrameBlock& frame, Viewport viewport,
                        double hiding_radius_m) {
  splats_.draw(spheres_, first, count, splat_view(frame, viewport, hiding_radius_m));
  large_.fill(splats_.large().data(), splats_.large().size_bytes());
}

int SplatPass::draw(Viewport viewport) {
  std::vector<RunInstance> instances;
  std::uint32_t blocks = 0;
  const std::vector<SphereSplats::Run> runs = splats_.runs();
  for (const SphereSplats::Run& run : runs) {
    const auto length = static_cast<std::uint32_t>(run.blocks.size());
    instances.push_back({run.column, run.row, length, blocks});
    blocks += length;
  }
  if (blocks == 0) return 0;
  pixels_.begin(blocks * sizeof(SplatBlock));
  for (std::size_t k = 0; k < runs.size(); ++k) {
    pixels_.put(instances[k].first_block * sizeof(SplatBlock), runs[k].blocks.data(), runs[k].blocks.size_bytes());
  }
  runs_.fill(instances.data(), instances.size() * sizeof(RunInstance));
  glVertexArrayVertexBuffer(array_.name(), 0, runs_.name(), 0, sizeof(RunInstance));
  glTextureBuffer(pixel_texture_.name(), GL_R32UI, pixels_.name());
  glProgramUniform2f(program_.name(), kSplatViewportUniform, float(viewport.width_px), float(viewport.height_px));
  glUseProgram(program_.name());
  glBindVertexArray(array_.name());
  glBindTextureUnit(0, pixel_texture_.name());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(instances.size()));
  return 1;
}

}  // namespace terrella
