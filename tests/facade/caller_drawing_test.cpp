// An application's own drawing inside a globe's frame, beside rays that are cast at the same things in double.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "caller_scene.h"

namespace terrella::test {
namespace {

class CallerDrawing : public GlTest, public testing::WithParamInterface<DepthMode> {
 protected:
  static std::unique_ptr<Globe> globe_of(double alpha) { return test::globe_of(GetParam(), alpha); }
  std::vector<bool> inked(int least_red) { return reds(picture(), least_red); }
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
    EXPECT_EQ(off_by_more_than_a_pixel(inked(128), truth), 0U);
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
  EXPECT_EQ(off_by_more_than_a_pixel(inked(64), truth_of(*globe, *box, true)), 0U);
  EXPECT_EQ(off_by_more_than_a_pixel(inked(200), truth_of(*globe, *box, false)), 0U);
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
  EXPECT_EQ(off_by_more_than_a_pixel(got, truth_of(*globe, *box, false)), 0U);
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
