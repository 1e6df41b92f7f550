#include "render/objects/sphere_pass.h"

#include <algorithm>
#include <array>
#include <vector>

#include "render/gl/shader_library.h"

namespace terrella {
namespace {

// Larger spheres are triangles. A point shows an elliptic outline, which is exact only for small spheres.
constexpr float kLargestPoint_px = 4.0F;
constexpr float kEdge_px = 1.0F;  // kEdge_px of object_sphere_seen.glsl, with room for rounding

/// OpenGL's indirect draw command.
struct SphereCommand {
  GLuint vertices, instances, first_vertex, first_instance;
};

SphereSight sight_of(const FrameBlock& frame, Viewport viewport, double hiding_radius_m, float largest_point_px) {
  return {.view_from_ecef = glm::mat3(frame.view_from_ecef),
          .eye_high_m = glm::vec3(frame.eye_high_ecef),
          .eye_low_m = glm::vec3(frame.eye_low_ecef),
          .clip_scale = glm::vec2(frame.clip_scale),
          .focal_px = 0.5F * float(viewport.height_px) * frame.clip_scale.y,
          .hiding_radius_m = static_cast<float>(hiding_radius_m),
          .largest_point_px = largest_point_px};
}

}  // namespace

Result<std::unique_ptr<SpherePass>> SpherePass::create(DepthMode depth) {
  std::unique_ptr<SpherePass> pass(new SpherePass);
  const auto build = [depth](gl::Program& program, std::string_view vertex, std::string_view fragment) {
    return build_into(
        program,
        {{GL_VERTEX_SHADER,
          {"frame.glsl", "object_common.glsl", "air_part.glsl", "object_air.glsl", "object_sphere_seen.glsl", vertex}},
         {GL_FRAGMENT_SHADER,
          {"frame.glsl", "object_common.glsl", "air_part.glsl", "object_air.glsl", "object_sphere_look.glsl",
           fragment}}},
        {depth_define(depth)});
  };
  if (Status s = build(pass->triangle_, "object_sphere.vert", "object_sphere.frag"); !s) return s.error();
  if (Status s = build(pass->point_, "object_sphere_point.vert", "object_sphere_point.frag"); !s) return s.error();
  pass->triangle_array_ = dot_array(1);
  pass->point_array_ = dot_array(0);
  std::array<GLfloat, 2> sizes_px{};
  glGetFloatv(GL_POINT_SIZE_RANGE, sizes_px.data());
  pass->largest_point_px_ = std::clamp(0.5F * sizes_px[1] - kEdge_px, 0.0F, kLargestPoint_px);
  return pass;
}

int SpherePass::draw(const DrawnLayer& layer, const ObjectDraw& draw, const FrameBlock& frame, Viewport viewport,
                     double hiding_radius_m) {
  SphereBatch& spheres = layer.objects->batches().spheres;
  const auto range = spheres.ranges.range(draw.part, draw.opaque, draw.choice);
  if (range.count == 0) return 0;
  for (const gl::VertexArray* array : {&triangle_array_, &point_array_}) {
    glVertexArrayVertexBuffer(array->name(), 0, layer.buffers->spheres.name(), 0, sizeof(DotInstance));
  }
  const SphereGroups::Seen seen =
      spheres.groups.seen({range.first, range.count}, sight_of(frame, viewport, hiding_radius_m, largest_point_px_));
  for (const gl::Program* program : {&triangle_, &point_}) {
    set_object_uniforms(*program, viewport, draw.depth_bias, hiding_radius_m);
  }
  if (!seen.triangles.empty()) draw_triangles(seen.triangles, draw.state);
  if (!seen.points.empty()) draw_points(seen.points, draw.state);
  return int(!seen.triangles.empty()) + int(!seen.points.empty());
}

void SpherePass::draw_triangles(const std::vector<SphereGroups::Run>& runs, const DrawState& state) {
  std::vector<SphereCommand> commands;
  for (const auto& run : runs) commands.push_back({3, GLuint(run.count), 0, GLuint(run.first)});
  commands_.fill(commands.data(), commands.size() * sizeof(SphereCommand));
  apply(state.with(triangle_.name()));
  glBindVertexArray(triangle_array_.name());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.name());
  glMultiDrawArraysIndirect(GL_TRIANGLES, nullptr, static_cast<GLsizei>(commands.size()), 0);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
}

void SpherePass::draw_points(const std::vector<SphereGroups::Run>& runs, DrawState state) const {
  std::vector<GLint> firsts;
  std::vector<GLsizei> counts;
  for (const auto& run : runs) {
    firsts.push_back(static_cast<GLint>(run.first));
    counts.push_back(static_cast<GLsizei>(run.count));
  }
  state.program_point_size = true;
  apply(state.with(point_.name()));
  glBindVertexArray(point_array_.name());
  glMultiDrawArrays(GL_POINTS, firsts.data(), counts.data(), static_cast<GLsizei>(runs.size()));
}

}  // namespace terrella
