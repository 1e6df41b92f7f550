#pragma once

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "geo/split_position.h"
#include "render/caller_glsl.h"
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

/// Draws a box, corners in ECEF, as an application would.
class Box {
 public:
  Box(const glm::dvec3& center_m, const glm::dmat3& axes, double half_m, DepthMode depth)
      : center_m_(center_m), axes_(axes), half_m_(half_m) {
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
    std::vector<glm::vec3> corners;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}}) {
          glm::dvec3 corner(0.0);
          corner[axis] = side;
          corner[u] = a * side;  // counterclockwise from outside
          corner[v] = b;
          const SplitPosition at = split_position(center_m + axes * (half_m * corner));
          corners.insert(corners.end(), {at.high, at.low});
        }
      }
    }
    glCreateBuffers(1, &buffer_);
    glNamedBufferStorage(buffer_, static_cast<GLsizeiptr>(corners.size() * sizeof(glm::vec3)), corners.data(), 0);
    glCreateVertexArrays(1, &array_);
    glVertexArrayVertexBuffer(array_, 0, buffer_, 0, 2 * sizeof(glm::vec3));
    for (const GLuint k : {0U, 1U}) {
      glEnableVertexArrayAttrib(array_, k);
      glVertexArrayAttribFormat(array_, k, 3, GL_FLOAT, GL_FALSE, k * sizeof(glm::vec3));
      glVertexArrayAttribBinding(array_, k, 0);
    }
  }
  ~Box() {
    glDeleteProgram(program_);
    glDeleteBuffers(1, &buffer_);
    glDeleteVertexArrays(1, &array_);
  }
  Box(const Box&) = delete;
  Box& operator=(const Box&) = delete;

  void draw() const {
    glUseProgram(program_);
    glBindVertexArray(array_);
    glDrawArrays(GL_TRIANGLES, 0, 36);
  }

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
  glm::dvec3 center_m_;
  glm::dmat3 axes_;
  double half_m_;
  GLuint program_ = 0, buffer_ = 0, array_ = 0;
};

/// A globe with waves, and a camera near them.
inline std::unique_ptr<Globe> globe_of(DepthMode depth, double alpha) {
  GlobeOptions options = unlit_options();
  options.depth = depth;
  options.relief_meshes_per_frame = 10000;
  options.surface.alpha = alpha;
  auto heights = ElevationSource::open(painted_heights({.tile_px = 128, .max_level = 5}, waves_m), "waves");
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

/// True for each pixel whose ray, cast in double, meets the box before the ground, or `any` place of the box.
inline std::vector<bool> truth_of(const Globe& globe, const Box& box, bool any) {
  const View view = globe.view(kScene);
  std::vector<bool> inked;
  for (int y = 0; y < kScene.height_px; ++y) {
    for (int x = 0; x < kScene.width_px; ++x) {
      const EcefDir ray = pixel_ray(view, {x + 0.5, y + 0.5});
      const double box_m = box.hit_m(view.eye.xyz_m, ray.xyz);
      const auto ground_m = globe.ground().intersect_m(view.eye, ray, 2e-4);
      inked.push_back(box_m < (any ? HUGE_VAL : ground_m.value_or(HUGE_VAL)));
    }
  }
  return inked;
}

/// Pixels that differ although all pixels next to them agree in the truth: off by more than a pixel.
inline int off_by_more_than_a_pixel(const std::vector<bool>& got, const std::vector<bool>& truth) {
  const int w = kScene.width_px;
  int off = 0;
  for (int y = 1; y + 1 < kScene.height_px; ++y) {
    for (int x = 1; x + 1 < w; ++x) {
      const auto at = [&](int dx, int dy) { return truth[static_cast<std::size_t>((y + dy) * w + x + dx)]; };
      bool border = false;
      for (int k = 0; k < 9; ++k) border = border || at(k % 3 - 1, k / 3 - 1) != at(0, 0);
      off += !border && got[static_cast<std::size_t>(y * w + x)] != at(0, 0) ? 1 : 0;
    }
  }
  return off;
}

}  // namespace terrella::test
