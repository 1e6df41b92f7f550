// An application's own drawing inside a globe's frame, beside rays that are cast at the same things in double.
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
namespace {

constexpr Viewport kScene{160, 120};

/// Waves of 300 m, which tiles of 0.04 degrees a texel follow.
double waves_m(double lat_rad, double lon_rad) { return 300.0 * std::sin(400.0 * lat_rad) * std::cos(400.0 * lon_rad); }

GLuint shader(GLenum type, const std::string& text) {
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

class CallerDrawing : public GlTest, public testing::WithParamInterface<DepthMode> {
 protected:
  std::unique_ptr<Globe> globe_of(double alpha) {
    GlobeOptions options = unlit_options();
    options.depth = GetParam();
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
  static std::unique_ptr<Box> box_of(const Globe& globe) {
    const Ellipsoid& body = globe.options().body.ellipsoid;
    const Geodetic foot{.lat = Angle::degrees(46.09), .lon = Angle::degrees(7.11), .height_m = 0.0};
    const glm::dvec3 up = Ellipsoid::normal(foot.lat, foot.lon).xyz;
    const glm::dvec3 u = glm::normalize(glm::cross(up, glm::dvec3(0.3, 0.1, 0.9)));
    return std::make_unique<Box>(body.to_ecef(foot).xyz_m, glm::dmat3(u, glm::cross(up, u), up), 1500.0, GetParam());
  }

  /// True for each pixel whose ray, cast in double, meets the box before the ground, or `any` place of the box.
  static std::vector<bool> truth_of(const Globe& globe, const Box& box, bool any) {
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
  static int off_by_more_than_a_pixel(const std::vector<bool>& got, const std::vector<bool>& truth) {
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

  std::vector<bool> inked(int least_red) {
    const Picture shot = picture();
    std::vector<bool> is;
    for (int y = 0; y < kScene.height_px; ++y) {
      for (int x = 0; x < kScene.width_px; ++x) is.push_back(shot.at(x, y)[0] >= least_red);
    }
    return is;
  }
};

TEST_P(CallerDrawing, ABoxMeetsTheGroundWhereRaysSayAtEachStage) {
  for (const DrawStage stage : {DrawStage::ground, DrawStage::all}) {
    const auto globe = globe_of(1.0);
    const auto box = box_of(*globe);
    int calls = 0;
    globe->on_draw([&](DrawStage at, const FrameMatrices& matrices) {
      if (at != stage) return;
      ++calls;
      EXPECT_EQ(matrices.depth, GetParam());
      box->draw();
      // A caller may leave any state behind.
      glDisable(GL_DEPTH_TEST);
      glClipControl(GL_UPPER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
      glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
      glFrontFace(GL_CW);
      glBindBufferBase(GL_UNIFORM_BUFFER, 0, 0);
    });
    settle(*globe, kScene);
    EXPECT_GT(calls, 0);
    const auto truth = truth_of(*globe, *box, false);
    EXPECT_GT(std::ranges::count(truth, true), 300);
    EXPECT_EQ(off_by_more_than_a_pixel(inked(128), truth), 0);
    // The next frames are drawn as ever.
    globe->on_draw({});
    settle(*globe, kScene);
    const auto without = picture().rgba;
    const auto fresh = globe_of(1.0);
    settle(*fresh, kScene);
    EXPECT_EQ(without, picture().rgba);
  }
}

// Under half-translucent ground the whole box shows, its part in the open undimmed.
TEST_P(CallerDrawing, ABoxShowsThroughATranslucentSurface) {
  const auto globe = globe_of(0.5);
  const auto box = box_of(*globe);
  globe->on_draw([&](DrawStage at, const FrameMatrices&) {
    if (at == DrawStage::below_ground || at == DrawStage::all) box->draw();
  });
  settle(*globe, kScene);
  EXPECT_EQ(off_by_more_than_a_pixel(inked(64), truth_of(*globe, *box, true)), 0);
  EXPECT_EQ(off_by_more_than_a_pixel(inked(200), truth_of(*globe, *box, false)), 0);
}

// The matrices say the same as the functions in GLSL, and as View.
TEST_P(CallerDrawing, MatricesProjectAsViewsDo) {
  const auto globe = globe_of(1.0);
  int seen = 0;
  globe->on_draw([&](DrawStage, const FrameMatrices& m) {
    for (const double lat : {46.05, 46.2, 47.0}) {
      const Ecef at = globe->options().body.ellipsoid.to_ecef(
          {.lat = Angle::degrees(lat), .lon = Angle::degrees(7.2), .height_m = 100.0});
      const auto px = project(m.view, at);
      if (!px) continue;
      const glm::dvec4 clip = m.clip_from_view * (m.view_from_ecef * glm::dvec4(at.xyz_m, 1.0));
      EXPECT_NEAR((clip.x / clip.w * 0.5 + 0.5) * kScene.width_px, px->x, 1e-6);
      EXPECT_NEAR((0.5 - clip.y / clip.w * 0.5) * kScene.height_px, px->y, 1e-6);
      EXPECT_TRUE(clip.z / clip.w > 0.0 && clip.z / clip.w < 1.0);
      ++seen;
    }
  });
  settle(*globe, kScene);
  EXPECT_GT(seen, 0);
}

// A framebuffer of the application's with four samples gets the globe's depth, and a box drawn there is cut by it.
TEST_P(CallerDrawing, DepthIsCopiedToAMultisampledFramebuffer) {
  const auto globe = globe_of(1.0);
  const auto box = box_of(*globe);
  settle(*globe, kScene);
  GLuint framebuffer = 0, color = 0, depth = 0;
  glCreateFramebuffers(1, &framebuffer);
  glCreateRenderbuffers(1, &color);
  glCreateRenderbuffers(1, &depth);
  glNamedRenderbufferStorageMultisample(color, 4, GL_RGBA8, kScene.width_px, kScene.height_px);
  glNamedRenderbufferStorageMultisample(depth, 4, GL_DEPTH_COMPONENT32F, kScene.width_px, kScene.height_px);
  glNamedFramebufferRenderbuffer(framebuffer, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
  glNamedFramebufferRenderbuffer(framebuffer, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
  GLint before = 0, after = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &before);
  ASSERT_TRUE(globe->copy_depth(framebuffer));
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &after);
  EXPECT_EQ(before, after);
  EXPECT_NE(globe->depth_texture(), 0U);

  // Draws there with matrices that the next frame gives.
  globe->on_draw([&](DrawStage at, const FrameMatrices&) {
    if (at != DrawStage::all) return;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, kScene.width_px, kScene.height_px);
    const float black[] = {0, 0, 0, 1};
    glClearNamedFramebufferfv(framebuffer, GL_COLOR, 0, black);
    box->draw();
  });
  draw(*globe, kScene);
  globe->on_draw({});
  GLuint flat = 0, texture = 0;
  glCreateFramebuffers(1, &flat);
  glCreateTextures(GL_TEXTURE_2D, 1, &texture);
  glTextureStorage2D(texture, 1, GL_RGBA8, kScene.width_px, kScene.height_px);
  glNamedFramebufferTexture(flat, GL_COLOR_ATTACHMENT0, texture, 0);
  glBlitNamedFramebuffer(framebuffer, flat, 0, 0, kScene.width_px, kScene.height_px, 0, 0, kScene.width_px,
                         kScene.height_px, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  std::vector<std::uint8_t> rgba(4UL * kScene.width_px * kScene.height_px);
  glGetTextureImage(texture, 0, GL_RGBA, GL_UNSIGNED_BYTE, static_cast<GLsizei>(rgba.size()), rgba.data());
  std::vector<bool> got;
  for (int y = kScene.height_px - 1; y >= 0; --y) {
    for (int x = 0; x < kScene.width_px; ++x) {
      got.push_back(rgba[4 * static_cast<std::size_t>(y * kScene.width_px + x)] >= 128);
    }
  }
  EXPECT_EQ(off_by_more_than_a_pixel(got, truth_of(*globe, *box, false)), 0);
  glDeleteFramebuffers(1, &framebuffer);
  glDeleteFramebuffers(1, &flat);
  glDeleteRenderbuffers(1, &color);
  glDeleteRenderbuffers(1, &depth);
  glDeleteTextures(1, &texture);
}

INSTANTIATE_TEST_SUITE_P(Depths, CallerDrawing,
                         testing::Values(DepthMode::reversed, DepthMode::logarithmic, DepthMode::standard));

}  // namespace
}  // namespace terrella::test
