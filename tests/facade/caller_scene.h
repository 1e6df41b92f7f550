#pragma once

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "geo/split_position.h"
#include "render/caller_glsl.h"
#include "render/gl/gl_handle.h"
#include "tests/gl/gl_fixture.h"
#include "tests/gl/painted_heights.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {

inline constexpr Viewport kScene{160, 120};

/// Waves of 300 m, which tiles of 0.04 degrees a texel follow.
inline double waves_m(double lat_rad, double lon_rad) {
  return 300.0 * std::sin(400.0 * lat_rad) * std::cos(400.0 * lon_rad);
}

/// Compiles a shader; fails the test if it cannot.
inline GLuint shader(GLenum type, const std::string& text) {
  const GLuint name = glCreateShader(type);
  const char* source = text.c_str();
  glShaderSource(name, 1, &source, nullptr);
  glCompileShader(name);
  GLint ok = 0;
  glGetShaderiv(name, GL_COMPILE_STATUS, &ok);
  char log[2048] = "";
  glGetShaderInfoLog(name, sizeof log, nullptr, log);
  EXPECT_EQ(ok, GL_TRUE) << log;
  return name;
}

/// Draws triangles, corners in ECEF, as an application would.
class CallerMesh {
 public:
  CallerMesh(DepthMode depth, const std::vector<glm::dvec3>& corners_m)
      : count_(static_cast<GLsizei>(corners_m.size())) {
    const std::string head = "#version 450 core\n" + caller_glsl(depth);
    program_ = glCreateProgram();
    const GLuint stages[] = {
        shader(GL_VERTEX_SHADER, head + "layout(location = 0) in vec3 high; layout(location = 1) in vec3 low;\n"
                                        "void main() { gl_Position = terrella_clip(terrella_from_eye(high, low)); }\n"),
        shader(GL_FRAGMENT_SHADER, head + "out vec4 color;\n"
                                          "void main() { color = vec4(1, 0, 1, 1); TERRELLA_WRITE_DEPTH; }\n")};
    for (const GLuint stage : stages) {
      glAttachShader(program_, stage);
      glDeleteShader(stage);
    }
    glLinkProgram(program_);
    std::vector<SplitPosition> corners;
    for (const glm::dvec3& corner_m : corners_m) corners.push_back(split_position(corner_m));
    glCreateBuffers(1, &buffer_);
    glNamedBufferStorage(buffer_, static_cast<GLsizeiptr>(corners.size() * sizeof(SplitPosition)), corners.data(), 0);
    glCreateVertexArrays(1, &array_);
    glVertexArrayVertexBuffer(array_, 0, buffer_, 0, sizeof(SplitPosition));
    for (const GLuint k : {0U, 1U}) {
      glEnableVertexArrayAttrib(array_, k);
      glVertexArrayAttribFormat(array_, k, 3, GL_FLOAT, GL_FALSE, k * sizeof(glm::vec3));
      glVertexArrayAttribBinding(array_, k, 0);
    }
  }
  ~CallerMesh() {
    glDeleteProgram(program_);
    glDeleteBuffers(1, &buffer_);
    glDeleteVertexArrays(1, &array_);
  }
  CallerMesh(const CallerMesh&) = delete;
  CallerMesh& operator=(const CallerMesh&) = delete;

  void draw() const {
    glUseProgram(program_);
    glBindVertexArray(array_);
    glDrawArrays(GL_TRIANGLES, 0, count_);
  }

 private:
  GLsizei count_;
  GLuint program_ = 0, buffer_ = 0, array_ = 0;
};
static_assert(sizeof(SplitPosition) == 2 * sizeof(glm::vec3));

/// A box.
class Box : public CallerMesh {
 public:
  Box(const glm::dvec3& center_m, const glm::dmat3& axes, double half_m, DepthMode depth)
      : CallerMesh(depth, corners(center_m, axes, half_m)), center_m_(center_m), axes_(axes), half_m_(half_m) {}

  /// Distance along a ray to the box; infinite if it misses.
  [[nodiscard]] double hit_m(const glm::dvec3& from_m, const glm::dvec3& way) const {
    const glm::dvec3 o = glm::transpose(axes_) * (from_m - center_m_), d = glm::transpose(axes_) * way;
    double enter = 0.0, leave = HUGE_VAL;
    for (int k = 0; k < 3; ++k) {
      const double a = (-half_m_ - o[k]) / d[k], b = (half_m_ - o[k]) / d[k];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter < leave ? enter : HUGE_VAL;
  }

 private:
  static std::vector<glm::dvec3> corners(const glm::dvec3& center_m, const glm::dmat3& axes, double half_m) {
    std::vector<glm::dvec3> all;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}}) {
          glm::dvec3 corner(0.0);
          corner[axis] = side;
          corner[u] = a * side;  // counterclockwise from outside
          corner[v] = b;
          all.push_back(center_m + axes * (half_m * corner));
        }
      }
    }
    return all;
  }

  glm::dvec3 center_m_;
  glm::dmat3 axes_;
  double half_m_;
};

/// The waves.
inline std::shared_ptr<TileSource> wave_heights() { return painted_heights({.tile_px = 128, .max_level = 5}, waves_m); }

/// A globe with waves or other heights, and a camera near them.
inline std::unique_ptr<Globe> globe_of(DepthMode depth, double alpha,
                                       const std::shared_ptr<TileSource>& ground = wave_heights()) {
  GlobeOptions options = unlit_options();
  options.depth = depth;
  options.relief_meshes_per_frame = 10000;
  options.surface.alpha = alpha;
  auto heights = ElevationSource::open(ground, "waves");
  EXPECT_TRUE(heights) << heights.error().message;
  auto globe = Globe::create(options, one_colour({.tile_px = 16, .max_level = 1}, {0, 160, 0}), *heights);
  EXPECT_TRUE(globe) << globe.error().message;
  (*globe)->set_camera(camera_at(46.0, 7.0, 8000.0, 40.0, -25.0));
  return *std::move(globe);
}

/// A box that stands 10 km before the eye, half in the ground, turned.
inline std::unique_ptr<Box> box_of(const Globe& globe) {
  const Ellipsoid& body = globe.options().body.ellipsoid;
  const Geodetic foot{.lat = Angle::degrees(46.09), .lon = Angle::degrees(7.11), .height_m = 0.0};
  const glm::dvec3 up = Ellipsoid::normal(foot.lat, foot.lon).xyz;
  const glm::dvec3 u = glm::normalize(glm::cross(up, glm::dvec3(0.3, 0.1, 0.9)));
  return std::make_unique<Box>(body.to_ecef(foot).xyz_m, glm::dmat3(u, glm::cross(up, u), up), 1500.0,
                               globe.options().depth);
}

/// True if the ray of a place in the picture, cast in double, meets a thing before the ground, or `any` place of it.
template <class Thing>
bool meets(const Globe& globe, const View& view, const Thing& thing, bool any, glm::dvec2 pixel_px) {
  const EcefDir ray = pixel_ray(view, pixel_px);
  const double thing_m = thing.hit_m(view.eye.xyz_m, ray.xyz);
  if (any || thing_m == HUGE_VAL) return thing_m < HUGE_VAL;
  return thing_m < globe.ground().intersect_m(view.eye, ray, 2e-4).value_or(HUGE_VAL);
}

/// The same for the middle of each pixel.
template <class Thing>
std::vector<bool> truth_of(const Globe& globe, const Thing& thing, bool any) {
  const View view = globe.view(kScene);
  std::vector<bool> inked;
  for (int y = 0; y < kScene.height_px; ++y) {
    for (int x = 0; x < kScene.width_px; ++x) {
      inked.push_back(meets(globe, view, thing, any, {x + 0.5, y + 0.5}));
    }
  }
  return inked;
}

inline constexpr int kSamples = 4;

/// A framebuffer of an application with samples.
class SampledTarget {
 public:
  explicit SampledTarget(Viewport size, int samples = kSamples)
      : size_(size),
        color_(gl::make_texture(GL_TEXTURE_2D_MULTISAMPLE)),
        depth_(gl::make_texture(GL_TEXTURE_2D_MULTISAMPLE)),
        framebuffer_(gl::make_framebuffer()) {
    glTextureStorage2DMultisample(color_.name(), samples, GL_RGB8, size.width_px, size.height_px, GL_TRUE);
    glTextureStorage2DMultisample(depth_.name(), samples, GL_DEPTH_COMPONENT32F, size.width_px, size.height_px,
                                  GL_TRUE);
    glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, color_.name(), 0);
    glNamedFramebufferTexture(framebuffer_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
  }
  [[nodiscard]] GLuint framebuffer() const { return framebuffer_.name(); }
  /// The means of the samples.
  [[nodiscard]] Picture read() const {
    gl::Texture flat = gl::make_texture(GL_TEXTURE_2D);
    glTextureStorage2D(flat.name(), 1, GL_RGB8, size_.width_px, size_.height_px);
    const gl::Framebuffer target = gl::make_framebuffer();
    glNamedFramebufferTexture(target.name(), GL_COLOR_ATTACHMENT0, flat.name(), 0);
    glBlitNamedFramebuffer(framebuffer_.name(), target.name(), 0, 0, size_.width_px, size_.height_px, 0, 0,
                           size_.width_px, size_.height_px, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    std::vector<std::uint8_t> rows(4UL * static_cast<std::size_t>(size_.width_px * size_.height_px));
    glGetTextureImage(flat.name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(rows.size()), rows.data());
    Picture picture{size_, {}};
    const auto row = 4 * static_cast<std::ptrdiff_t>(size_.width_px);
    for (int y = size_.height_px; y-- > 0;) {
      picture.rgba.insert(picture.rgba.end(), rows.begin() + y * row, rows.begin() + (y + 1) * row);
    }
    return picture;
  }

 private:
  Viewport size_;
  gl::Texture color_, depth_;
  gl::Framebuffer framebuffer_;
};

inline void settle_into(Globe& globe, const SampledTarget& target, Viewport size) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  EXPECT_TRUE(globe.render_until_settled(target.framebuffer(), size, deadline)) << globe.status().ok();
  globe.render(target.framebuffer(), size);
  EXPECT_TRUE(globe.status());
}

/// True for each pixel with so much red.
inline std::vector<bool> reds(const Picture& picture, int least) {
  std::vector<bool> is;
  for (int y = 0; y < picture.size.height_px; ++y) {
    for (int x = 0; x < picture.size.width_px; ++x) is.push_back(picture.at(x, y)[0] >= least);
  }
  return is;
}

/// Pixels that differ although all pixels next to them agree in the truth.
inline std::vector<glm::ivec2> pixels_off(const std::vector<bool>& got, const std::vector<bool>& truth) {
  const int w = kScene.width_px;
  std::vector<glm::ivec2> off;
  for (int y = 1; y + 1 < kScene.height_px; ++y) {
    for (int x = 1; x + 1 < w; ++x) {
      const auto at = [&](int dx, int dy) { return truth[static_cast<std::size_t>((y + dy) * w + x + dx)]; };
      bool border = false;
      for (int k = 0; k < 9; ++k) border = border || at(k % 3 - 1, k / 3 - 1) != at(0, 0);
      if (!border && got[static_cast<std::size_t>(y * w + x)] != at(0, 0)) off.emplace_back(x, y);
    }
  }
  return off;
}
inline std::size_t off_by_more_than_a_pixel(const std::vector<bool>& got, const std::vector<bool>& truth) {
  return pixels_off(got, truth).size();
}

}  // namespace terrella::test
