#include "render/gl/shader_functions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/vec4.hpp>
#include <numbers>
#include <vector>

#include "render/gl/shader_library.h"

namespace terrella {
namespace {

constexpr int kArguments = 2048;
constexpr double kSmallestAngle = 1e-7;

/// The two rows of shaders/probes/probe_functions.frag, as floats: results are compared for the exact arguments of the
/// shader.
struct Arguments {
  std::vector<glm::vec4> angles, radicands;
};

// Half of the angles are spread evenly round the circle. The other half goes down to the smallest sizes, where a coarse
// polynomial loses relative accuracy.
double angle_at(int k) {
  const int pair = k / 2;
  const double part = (pair + 0.5) / (0.5 * kArguments);
  if (k % 2 == 0) return std::numbers::pi * (2.0 * part - 1.0);
  return (k % 4 == 1 ? 1.0 : -1.0) * std::pow(kSmallestAngle, part);
}

Arguments make_arguments() {
  Arguments arguments;
  for (int k = 0; k < kArguments; ++k) {
    const double angle = angle_at(k), part = (k + 0.5) / kArguments;
    // Varied, so that neither component is always the same float.
    const double radius = std::exp2(std::fmod(k * 0.61803398875, 1.0) - 0.5);
    arguments.angles.emplace_back(radius * std::sin(angle), radius * std::cos(angle), 2.0 * part - 1.0, angle);
    const double length = 2.0 * std::pow(0.5e-7, part);
    arguments.radicands.emplace_back(4.0 * std::pow(0.25e-12, part), length * std::sin(angle), length * std::cos(angle),
                                     0.0);
  }
  return arguments;
}

gl::Texture row_texture(const std::vector<glm::vec4>* texels) {
  gl::Texture texture = gl::make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, GL_RGBA32F, kArguments, 1);
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  if (texels != nullptr) {
    glTextureSubImage2D(texture.name(), 0, 0, 0, kArguments, 1, GL_RGBA, GL_FLOAT, texels->data());
  }
  return texture;
}

std::vector<glm::vec4> read_row(const gl::Texture& texture) {
  std::vector<glm::vec4> texels(kArguments);
  glGetTextureImage(texture.name(), 0, GL_RGBA, GL_FLOAT, kArguments * sizeof(glm::vec4), texels.data());
  return texels;
}

struct Values {
  std::vector<glm::vec4> angles, roots;
};

Values draw_row(const gl::Program& program, const Arguments& arguments) {
  const gl::Texture angles = row_texture(&arguments.angles), radicands = row_texture(&arguments.radicands);
  const gl::Texture angles_out = row_texture(nullptr), roots_out = row_texture(nullptr);
  const gl::Framebuffer framebuffer = gl::make_framebuffer();
  glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0, angles_out.name(), 0);
  glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT1, roots_out.name(), 0);
  const GLenum outputs[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glNamedFramebufferDrawBuffers(framebuffer.name(), 2, outputs);
  const gl::VertexArray nothing = gl::make_vertex_array();
  GLint bound = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glViewport(0, 0, kArguments, 1);
  for (const GLenum state : {GL_BLEND, GL_DEPTH_TEST, GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_CULL_FACE}) glDisable(state);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glUseProgram(program.name());
  glBindTextureUnit(0, angles.name());
  glBindTextureUnit(1, radicands.name());
  for (GLuint unit : {0U, 1U}) glBindSampler(unit, 0);
  glBindVertexArray(nothing.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glUseProgram(0);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(bound));
  return {read_row(angles_out), read_row(roots_out)};
}

// A result that is not a number counts as an infinite error.
void note(double& worst, double error) { worst = std::isfinite(error) ? std::max(worst, std::abs(error)) : HUGE_VAL; }

FunctionErrors compare(const Arguments& arguments, const Values& values) {
  FunctionErrors errors;
  for (std::size_t k = 0; k < kArguments; ++k) {
    const glm::dvec4 of(arguments.angles[k]), got(values.angles[k]);
    const double angle = std::atan2(of.x, of.y);
    note(errors.atan, got.x / angle - 1.0);
    note(errors.asin, got.y - std::asin(of.z));
    note(errors.sine, got.z - std::sin(of.w));
    note(errors.cosine, got.w - std::cos(of.w));
    const glm::dvec4 under(arguments.radicands[k]), root(values.roots[k]);
    note(errors.inversesqrt, root.x * std::sqrt(under.x) - 1.0);
    note(errors.length, root.y / std::hypot(under.y, under.z) - 1.0);
  }
  return errors;
}

}  // namespace

std::string_view functions_define(ShaderFunctions functions) {
  return functions == ShaderFunctions::own ? "OWN_FUNCTIONS" : "DRIVER_FUNCTIONS";
}

bool good_enough(const FunctionErrors& e) {
  return std::max({e.atan, e.sine, e.cosine, e.inversesqrt, e.length}) <= kMostFunctionError;
}

Result<FunctionErrors> measure_shader_functions(ShaderFunctions functions) {
  const Result<gl::Program> program = build_program(
      {{GL_VERTEX_SHADER, {"interlace.vert"}}, {GL_FRAGMENT_SHADER, {"functions.glsl", "probe_functions.frag"}}},
      {functions_define(functions)});
  if (!program) return program.error();
  const Arguments arguments = make_arguments();
  return compare(arguments, draw_row(*program, arguments));
}

Result<ShaderFunctions> choose_shader_functions() {
  const Result<FunctionErrors> errors = measure_shader_functions(ShaderFunctions::driver);
  if (!errors) return errors.error();
  return good_enough(*errors) ? ShaderFunctions::driver : ShaderFunctions::own;
}

}  // namespace terrella
