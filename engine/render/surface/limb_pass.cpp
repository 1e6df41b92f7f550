#include "render/surface/limb_pass.h"

#include <cmath>
#include <cstddef>
#include <glm/gtc/type_ptr.hpp>
#include <string_view>

#include "render/gl/shader_library.h"
#include "render/gl/vertex_attribute.h"
#include "surface/limb.h"

namespace terrella {
namespace {
// Half a pixel of coverage to either side, plus the error of the mesh.
constexpr double kHalfWidth_px = 1.0;

// Turns a fragment's place, pixels from the lower left corner of the view, into a ray in the axes of the horizon.
glm::mat3 horizon_from_px(const View& view, const AirTextures& air) {
  const double scale = 1.0 / view.pixels_per_radian();
  const glm::dvec3 corner = view.forward + view.right * (view.shear_x - 0.5 * scale * view.viewport.width_px) -
                            view.up * (0.5 * scale * view.viewport.height_px);
  const glm::dmat3 ecef_from_px(view.right * scale, view.up * scale, corner);
  return glm::mat3(air.horizon_from_ecef() * ecef_from_px);
}

void set_air(const View& view, const AirTextures& air) {
  const glm::mat3 axes = horizon_from_px(view, air);
  glUniformMatrix3fv(2, 1, GL_FALSE, glm::value_ptr(axes));
  const double r = air.eye_radius(), limb = std::sqrt((r - 1.0) * (r + 1.0));
  glUniform3f(3, static_cast<float>(limb), static_cast<float>(air.limb_pixel()), SkyColors::kLimbSteps);
  air.bind_limb();
  air.bind_ground();
}
}  // namespace

LimbPass::LimbPass() : vertex_array_(gl::make_vertex_array()), vertices_(gl::make_buffer()) {
  const GLuint array = vertex_array_.name();
  glVertexArrayVertexBuffer(array, 0, vertices_.name(), 0, sizeof(LimbVertex));
  gl::float_attribute(array, 0, 0, 2, offsetof(LimbVertex, position_ndc));
  gl::float_attribute(array, 1, 0, 2, offsetof(LimbVertex, outward_px));
  gl::float_attribute(array, 2, 0, 1, offsetof(LimbVertex, distance_px));
}

Status LimbPass::prepare(LimbLook look, bool from_samples) {
  gl::Program& program = programs_[from_samples ? 1 : 0][static_cast<std::size_t>(look)];
  if (program) return Done{};
  constexpr std::string_view kFiles[] = {"limb.frag", "limb_air.frag", "limb_whole.frag", "limb_air.frag"};
  const std::string_view fragment = kFiles[static_cast<std::size_t>(look)];
  return build_into(program, {{GL_VERTEX_SHADER, {"limb.vert"}}, {GL_FRAGMENT_SHADER, {"limb_pixel.glsl", fragment}}},
                    {look == LimbLook::in_air ? "AIR" : "NO_AIR", from_samples ? "FROM_SAMPLES" : "FROM_CENTRES"});
}

bool LimbPass::fit(const View& view, const Ellipsoid& ellipsoid) {
  const std::vector<LimbVertex> strip = limb_ribbon(view, ellipsoid, kHalfWidth_px);
  count_ = static_cast<GLsizei>(strip.size());
  if (strip.empty()) return false;
  glNamedBufferData(vertices_.name(), static_cast<GLsizeiptr>(strip.size() * sizeof(LimbVertex)), strip.data(),
                    GL_STREAM_DRAW);
  return true;
}

void LimbPass::draw(const View& view, const LimbPicture& picture, LimbLook look, const AirTextures* air,
                    DrawState state) const {
  state.depth.reset();
  state.cull.reset();
  apply(state.with(programs_[picture.from_samples ? 1 : 0][static_cast<std::size_t>(look)].name()));
  glUniform1i(0, picture.rows_apart);
  glUniform4i(1, picture.left_px, 0, picture.left_px + view.viewport.width_px - 1, view.viewport.height_px - 1);
  if (look == LimbLook::in_air) set_air(view, *air);
  glBindTextureUnit(0, picture.texture);
  glBindSampler(0, 0);
  glBindVertexArray(vertex_array_.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, count_);
}

}  // namespace terrella
