// A framebuffer that cannot be drawn into is named by status(), and leaves no error of OpenGL.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "tests/gl/gl_fixture.h"

namespace terrella::test {
namespace {

constexpr Viewport kWanted{32, 32};

/// A framebuffer with textures of these formats; 0: none.
struct AnyFramebuffer {
  AnyFramebuffer(GLenum color_format, GLenum depth_format, int depth_side_px = kWanted.width_px) {
    if (color_format != 0) {
      glTextureStorage2D(color.name(), 1, color_format, kWanted.width_px, kWanted.height_px);
      glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0, color.name(), 0);
    }
    if (depth_format == 0) return;
    glTextureStorage2D(depth.name(), 1, depth_format, depth_side_px, depth_side_px);
    glNamedFramebufferTexture(framebuffer.name(), GL_DEPTH_ATTACHMENT, depth.name(), 0);
  }
  gl::Texture color = gl::make_texture(GL_TEXTURE_2D), depth = gl::make_texture(GL_TEXTURE_2D);
  gl::Framebuffer framebuffer = gl::make_framebuffer();
};

class Framebuffers : public GlTest {
 protected:
  void expect_refused(GLuint framebuffer, const char* why) {
    const auto globe = make_globe(unlit_options(), one_colour({.tile_px = 16}, {0, 200, 0}));
    globe->render(framebuffer, kWanted);
    const std::string message = globe->status() ? "no error" : globe->status().error().message;
    EXPECT_NE(message.find(why), std::string::npos) << message;
    EXPECT_FALSE(globe->settled());
    EXPECT_FALSE(
        globe->render_until_settled(framebuffer, kWanted, std::chrono::steady_clock::now() + std::chrono::minutes(1)));
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    const AnyFramebuffer good(GL_RGBA8, 0);
    EXPECT_GT(globe->render(good.framebuffer.name(), kWanted).patches, 0);
    EXPECT_TRUE(globe->status());
  }
};

TEST_F(Framebuffers, OneThatIsNotThere) {
  expect_refused(4711, "Globe::render: there is no framebuffer 4711");
  expect_refused(0, "the context has no window");
}

TEST_F(Framebuffers, OneThatIsIncomplete) {
  const AnyFramebuffer empty(0, 0);
  expect_refused(empty.framebuffer.name(), "it has no attachment");
  AnyFramebuffer wrong(GL_RGBA8, 0);
  glNamedFramebufferTexture(wrong.framebuffer.name(), GL_DEPTH_ATTACHMENT, wrong.color.name(), 0);
  expect_refused(wrong.framebuffer.name(), "an attachment cannot be drawn into");
}

TEST_F(Framebuffers, OneWithoutColours) {
  const AnyFramebuffer depth(0, GL_DEPTH_COMPONENT32F), numbers(GL_RGBA8UI, 0), off(GL_RGBA8, 0);
  expect_refused(depth.framebuffer.name(), "draws no colours");
  expect_refused(numbers.framebuffer.name(), "has whole numbers in place of colours");
  glNamedFramebufferDrawBuffer(off.framebuffer.name(), GL_NONE);
  expect_refused(off.framebuffer.name(), "draws no colours");
}

TEST_F(Framebuffers, DepthIsCopiedOnlyToDepth) {
  const auto globe = make_globe(unlit_options(), one_colour({.tile_px = 16}, {0, 200, 0}));
  const AnyFramebuffer color(GL_RGBA8, 0), depth(0, GL_DEPTH_COMPONENT32F);
  globe->render(color.framebuffer.name(), kWanted);
  EXPECT_TRUE(globe->copy_depth(depth.framebuffer.name()));
  for (const GLuint wrong : {color.framebuffer.name(), 4711U, 0U}) {
    const Status copied = globe->copy_depth(wrong);
    ASSERT_FALSE(copied);
    EXPECT_EQ(copied.error().message.rfind("Globe::copy_depth: ", 0), 0U) << copied.error().message;
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
  }
}

}  // namespace
}  // namespace terrella::test
