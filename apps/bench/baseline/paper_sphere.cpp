#include "apps/bench/baseline/paper_sphere.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/bench/baseline/paper_mesh.h"

namespace terrella::bench {
namespace {

constexpr const char* kVertexShader = R"(#version 450 core
layout(location = 0) in vec3 unit;
layout(location = 1) in vec2 uv;
layout(location = 0) uniform mat4 clip_from_unit;
out vec2 texture_uv;
out vec3 unit_position;
void main() {
  texture_uv = uv;
  unit_position = unit;
  gl_Position = clip_from_unit * vec4(unit, 1.0);
})";

constexpr const char* kPlainShader = R"(#version 450 core
layout(binding = 0) uniform sampler2D planet;
in vec2 texture_uv;
layout(location = 0) out vec4 colour;
void main() { colour = texture(planet, texture_uv); })";

// As printed in the paper, with a guard where (6) divides by zero.
constexpr const char* kBandsShader = R"(#version 450 core
layout(binding = 0) uniform sampler2D planet;
layout(location = 1) uniform vec2 a_and_band;
in vec2 texture_uv;
in vec3 unit_position;
layout(location = 0) out vec4 colour;
void main() {
  float b = a_and_band.y;
  if (texture_uv.y >= b && texture_uv.y <= 1.0 - b) {
    colour = texture(planet, texture_uv);
    return;
  }
  vec3 p = normalize(unit_position);
  vec2 uv = vec2(0.5 + atan(p.y, p.x) / 6.283185307, 0.5 - asin(clamp(p.z, -1.0, 1.0)) / 3.141592654);
  float level = textureQueryLod(planet, uv).y;
  float v = uv.y > 0.5 ? (uv.y - (1.0 - b)) / b : 1.0 - uv.y / b;           // (5)
  colour = textureLod(planet, uv, max(0.0, level - 1.0) / max(a_and_band.x * v, 1e-6));  // (6)
})";

constexpr const char* kExactShader = R"(#version 450 core
layout(binding = 0) uniform sampler2D planet;
in vec3 unit_position;
layout(location = 0) out vec4 colour;
const vec2 kPerRadian = vec2(0.1591549431, -0.3183098862);
vec2 change(vec3 p, vec3 d) {
  float r = max(length(p.xy), 1e-7);
  return vec2((p.x * d.y - p.y * d.x) / (r * r), (r * d.z - p.z * dot(p.xy, d.xy) / r) / dot(p, p)) * kPerRadian;
}
void main() {
  vec3 p = unit_position;
  vec2 uv = vec2(0.5, 0.5) + vec2(atan(p.y, p.x), atan(p.z, length(p.xy))) * kPerRadian;
  colour = textureGrad(planet, uv, change(p, dFdx(p)), change(p, dFdy(p)));
})";

constexpr std::array<const char*, 3> kFragmentShaders{kPlainShader, kBandsShader, kExactShader};

GLuint compiled(GLenum stage, const char* source) {
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  return shader;
}

}  // namespace

glm::mat4 clip_from_unit_sphere(const truth::TruthCamera& camera, double radius_m) {
  const truth::LocalFrame frame = truth::local_frame(camera.eye.lat_deg, camera.eye.lon_deg);
  const glm::dvec3 eye = (1.0 + camera.eye.height_m / radius_m) * frame.up;
  const truth::PixelRays rays({radius_m, 0.0}, camera, 2, 2);
  const glm::dvec3 forward = rays.direction({1.0, 1.0});
  const glm::dvec3 up = rays.direction({1.0, 0.0}) - forward;
  const double height = camera.eye.height_m / radius_m;
  const glm::dmat4 clip_from_view =
      glm::perspective(camera.fov_deg * std::numbers::pi / 180.0, 1.0, 0.5 * height, height + 2.0);
  return glm::mat4(clip_from_view * glm::lookAt(eye, eye + forward, up));
}

PaperSphere::PaperSphere(const truth::Picture& picture, int n, int size_px) : size_px_(size_px) {
  make_programs();
  make_mesh(n);
  make_texture(picture);
  make_target();
}

PaperSphere::~PaperSphere() {
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteRenderbuffers(1, &colour_);
  glDeleteRenderbuffers(1, &depth_);
  glDeleteTextures(1, &texture_);
  glDeleteVertexArrays(1, &vertex_array_);
  glDeleteBuffers(1, &vertices_);
  glDeleteBuffers(1, &indices_);
  for (const GLuint program : programs_) glDeleteProgram(program);
}

void PaperSphere::make_programs() {
  for (std::size_t k = 0; k < programs_.size(); ++k) {
    programs_[k] = glCreateProgram();
    for (const GLuint shader :
         {compiled(GL_VERTEX_SHADER, kVertexShader), compiled(GL_FRAGMENT_SHADER, kFragmentShaders[k])}) {
      glAttachShader(programs_[k], shader);
      glDeleteShader(shader);  // the shader lives as long as the program
    }
    glLinkProgram(programs_[k]);
    GLint linked = GL_FALSE;
    glGetProgramiv(programs_[k], GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) throw std::runtime_error("the paper sphere's shaders do not link with this OpenGL driver");
  }
}

void PaperSphere::make_mesh(int n) {
  const PaperMesh mesh = paper_mesh(n);
  index_count_ = static_cast<int>(mesh.indices.size());
  vertex_count_ = static_cast<int>(mesh.vertices.size());
  glCreateBuffers(1, &vertices_);
  glNamedBufferStorage(vertices_, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(PaperVertex)),
                       mesh.vertices.data(), 0);
  glCreateBuffers(1, &indices_);
  glNamedBufferStorage(indices_, static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(std::uint32_t)),
                       mesh.indices.data(), 0);
  glCreateVertexArrays(1, &vertex_array_);
  glVertexArrayVertexBuffer(vertex_array_, 0, vertices_, 0, sizeof(PaperVertex));
  glVertexArrayElementBuffer(vertex_array_, indices_);
  const auto attribute = [this](GLuint location, GLint components, std::size_t offset) {
    glEnableVertexArrayAttrib(vertex_array_, location);
    glVertexArrayAttribFormat(vertex_array_, location, components, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
    glVertexArrayAttribBinding(vertex_array_, location, 0);
  };
  attribute(0, 3, offsetof(PaperVertex, unit));
  attribute(1, 2, offsetof(PaperVertex, uv));
}

void PaperSphere::make_texture(const truth::Picture& picture) {
  int levels = 1;
  while (std::max(picture.width, picture.height) >> levels > 0) ++levels;
  glCreateTextures(GL_TEXTURE_2D, 1, &texture_);
  glTextureStorage2D(texture_, levels, GL_RGBA8, picture.width, picture.height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture_, 0, 0, 0, picture.width, picture.height, GL_RGB, GL_UNSIGNED_BYTE, picture.rgb.data());
  glGenerateTextureMipmap(texture_);
  glTextureParameteri(texture_, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(texture_, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(texture_, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTextureParameteri(texture_, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void PaperSphere::make_target() {
  glCreateRenderbuffers(1, &colour_);
  glNamedRenderbufferStorage(colour_, GL_RGBA8, size_px_, size_px_);
  glCreateRenderbuffers(1, &depth_);
  glNamedRenderbufferStorage(depth_, GL_DEPTH_COMPONENT24, size_px_, size_px_);
  glCreateFramebuffers(1, &framebuffer_);
  glNamedFramebufferRenderbuffer(framebuffer_, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
  glNamedFramebufferRenderbuffer(framebuffer_, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
}

void PaperSphere::clear() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, size_px_, size_px_);
  glDepthMask(GL_TRUE);
  glClearColor(0, 0, 0, 1);
  glClearDepth(1.0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void PaperSphere::draw(const truth::TruthCamera& camera, double radius_m, const PaperLook& look) const {
  const glm::mat4 clip_from_unit = clip_from_unit_sphere(camera, radius_m);
  clear();
  glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
  glDisable(GL_BLEND);
  glDisable(GL_STENCIL_TEST);
  glUseProgram(programs_[static_cast<std::size_t>(look.method)]);
  glUniformMatrix4fv(0, 1, GL_FALSE, glm::value_ptr(clip_from_unit));
  if (look.method == PaperLook::Method::bands) {
    glUniform2f(1, static_cast<float>(look.a), static_cast<float>(look.band));
  }
  glTextureParameterf(texture_, GL_TEXTURE_MAX_ANISOTROPY, static_cast<float>(look.anisotropy));
  glBindTextureUnit(0, texture_);
  glBindSampler(0, 0);
  glBindVertexArray(vertex_array_);
  glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
}

double PaperSphere::frame_ms(const truth::TruthCamera& camera, double radius_m, int frames) const {
  constexpr int kWarmUp = 2;
  std::vector<double> times_ms;
  for (int i = 0; i < frames + kWarmUp; ++i) {
    const auto start = std::chrono::steady_clock::now();
    draw(camera, radius_m);
    glFinish();
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    if (i >= kWarmUp) times_ms.push_back(took.count());
  }
  const auto middle = times_ms.begin() + static_cast<std::ptrdiff_t>(times_ms.size() / 2);
  std::nth_element(times_ms.begin(), middle, times_ms.end());
  return *middle;
}

truth::Picture PaperSphere::read_back() const {
  const auto row = 3 * static_cast<std::size_t>(size_px_);
  std::vector<std::uint8_t> bottom_first(row * static_cast<std::size_t>(size_px_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, size_px_, size_px_, GL_RGB, GL_UNSIGNED_BYTE, bottom_first.data());
  truth::Picture picture{size_px_, size_px_, {}};
  for (std::size_t y = static_cast<std::size_t>(size_px_); y-- > 0;) {
    const auto from = bottom_first.begin() + static_cast<std::ptrdiff_t>(y * row);
    picture.rgb.insert(picture.rgb.end(), from, from + static_cast<std::ptrdiff_t>(row));
  }
  return picture;
}

}  // namespace terrella::bench
