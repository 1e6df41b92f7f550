#include "render/surface/inner_sphere_pass.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <numbers>
#include <vector>

#include "render/gl/shader_library.h"
#include "render/gl/vertex_attribute.h"

namespace terrella {
namespace {

// Rows of quads from pole to pole; there are twice as many around. The mesh sags by 1/1900 of the radius, 3 km on
// Earth.
constexpr int kRows = 48;

}  // namespace

Result<std::unique_ptr<InnerSpherePass>> InnerSpherePass::create(DepthMode depth) {
  std::unique_ptr<InnerSpherePass> pass(new InnerSpherePass);
  if (Status s = build_into(pass->program_,
                            {{GL_VERTEX_SHADER, {"frame.glsl", "inner_sphere.vert"}},
                             {GL_FRAGMENT_SHADER, {"frame.glsl", "inner_sphere.frag"}}},
                            {depth_define(depth)});
      !s)
    return s.error();
  constexpr int kColumns = 2 * kRows;
  std::vector<glm::vec3> points;
  std::vector<std::uint16_t> triangles;
  for (int j = 0; j <= kRows; ++j) {
    for (int i = 0; i <= kColumns; ++i) {
      const double lat = std::numbers::pi * (double(j) / kRows - 0.5), lon = 2.0 * std::numbers::pi * i / kColumns;
      points.emplace_back(std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat));
      if (j == kRows || i == kColumns) continue;
      const int a = j * (kColumns + 1) + i, c = a + kColumns + 1;
      for (int k : {a, a + 1, c + 1, a, c + 1, c}) triangles.push_back(static_cast<std::uint16_t>(k));
    }
  }
  pass->count_ = static_cast<GLsizei>(triangles.size());
  pass->vertex_array_ = gl::make_vertex_array();
  pass->vertices_ = gl::make_buffer();
  pass->indices_ = gl::make_buffer();
  glNamedBufferStorage(pass->vertices_.name(), static_cast<GLsizeiptr>(points.size() * sizeof(glm::vec3)),
                       points.data(), 0);
  glNamedBufferStorage(pass->indices_.name(), static_cast<GLsizeiptr>(triangles.size() * sizeof(std::uint16_t)),
                       triangles.data(), 0);
  const GLuint array = pass->vertex_array_.name();
  glVertexArrayVertexBuffer(array, 0, pass->vertices_.name(), 0, sizeof(glm::vec3));
  glVertexArrayElementBuffer(array, pass->indices_.name());
  pass->curtain_ = gl::make_buffer();
  pass->curtain_array_ = gl::make_vertex_array();
  glVertexArrayVertexBuffer(pass->curtain_array_.name(), 0, pass->curtain_.name(), 0, sizeof(glm::vec3));
  for (const GLuint each : {array, pass->curtain_array_.name()}) gl::float_attribute(each, 0, 0, 3, 0);
  return pass;
}

int InnerSpherePass::draw(double radius_m, const glm::vec3& color_srgb, const DrawState& state) const {
  apply(state.with(program_.name()));
  glUniform2f(0, static_cast<float>(radius_m), 1.0F);
  glUniform3f(1, color_srgb.x, color_srgb.y, color_srgb.z);
  glBindVertexArray(vertex_array_.name());
  glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_SHORT, nullptr);
  return 1;
}

int InnerSpherePass::draw_curtain(const std::vector<glm::vec3>& strip, const glm::vec3& color_srgb,
                                  DrawState state) const {
  if (strip.empty()) return 0;
  glNamedBufferData(curtain_.name(), static_cast<GLsizeiptr>(strip.size() * sizeof(glm::vec3)), strip.data(),
                    GL_STREAM_DRAW);
  state.cull.reset();
  apply(state.with(program_.name()));
  glUniform2f(0, 1.0F, 0.0F);
  glUniform3f(1, color_srgb.x, color_srgb.y, color_srgb.z);
  glBindVertexArray(curtain_array_.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, static_cast<GLsizei>(strip.size()));
  return 1;
}

}  // namespace terrella
