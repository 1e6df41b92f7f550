// Shader programs that only some frames need, in an installation where they do not compile.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "render/gl/shader_library.h"
#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"

namespace terrella::test {
namespace {

constexpr Viewport kBroken{64, 64};
const TileGrid kGrid{.tile_px = 64, .max_level = 1};

/// Shaders are read from a folder where one of them is not GLSL.
class BrokenShader {
 public:
  explicit BrokenShader(const std::string& name) : folder_(testing::TempDir() + "broken_" + name) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / name) << "this is no shader\n";
    read_shaders_from(folder_);
    glDisable(GL_DEBUG_OUTPUT);  // the fixture fails a test whose driver complains
  }
  ~BrokenShader() {
    glEnable(GL_DEBUG_OUTPUT);
    read_shaders_from({});
    std::filesystem::remove_all(folder_);
  }
  BrokenShader(const BrokenShader&) = delete;
  BrokenShader& operator=(const BrokenShader&) = delete;

 private:
  std::filesystem::path folder_;
};

class BrokenPrograms : public GlTest {
 protected:
  /// Draws a frame that is the first to need the program, then one after the installation is mended.
  void expect_error_then_picture(Globe& globe, const std::string& shader) {
    const Picture before = picture();
    {
      const BrokenShader broken(shader);
      EXPECT_EQ(draw(globe, kBroken).draw_calls, 0);
      ASSERT_FALSE(globe.status()) << shader;
      EXPECT_NE(globe.status().error().message.find(shader), std::string::npos) << globe.status().error().message;
      EXPECT_FALSE(globe.settled());
      OffscreenTarget other(kBroken);
      const auto late = std::chrono::steady_clock::now() + std::chrono::hours(1);
      EXPECT_FALSE(globe.render_until_settled(other.framebuffer(), kBroken, late));
    }
    EXPECT_EQ(picture().rgba, before.rgba) << "nothing is drawn";
    EXPECT_GT(settle(globe, kBroken).draw_calls, 0);
    EXPECT_TRUE(globe.status());
  }
  std::unique_ptr<Globe> plain_globe() {
    auto globe = make_globe({}, one_colour(kGrid, {200, 120, 40}));
    globe->set_camera(camera_at(10, 20, 2.0e7));
    settle(*globe, kBroken);
    EXPECT_TRUE(globe->status());
    return globe;
  }
};

TEST_F(BrokenPrograms, TranslucencyIsAnError) {
  const auto globe = plain_globe();
  globe->set_surface({.alpha = 0.5});
  expect_error_then_picture(*globe, "patch_depth.frag");
}

TEST_F(BrokenPrograms, TheInnerSphereIsAnError) {
  const auto globe = plain_globe();
  globe->set_surface({.alpha = 0.5});
  settle(*globe, kBroken);
  ASSERT_TRUE(globe->add_objects({.points = {{.place = {.lat = {}, .lon = {}, .height_m = -2.0e5}}}}));
  expect_error_then_picture(*globe, "inner_sphere.frag");
}

TEST_F(BrokenPrograms, InterlacedStereoIsAnError) {
  const auto globe = plain_globe();
  globe->set_stereo({.mode = Stereo::interlaced, .eye_separation_m = {}});
  expect_error_then_picture(*globe, "interlace.frag");
}

TEST_F(BrokenPrograms, ASecondLayerIsAnError) {
  const auto globe = plain_globe();
  ASSERT_TRUE(globe->add_imagery(one_colour(kGrid, {0, 120, 40}), {.opacity = 0.5}));
  expect_error_then_picture(*globe, "patch_flat.frag");
}

#ifdef NDEBUG
TEST(ShaderFolder, TheEnvironmentHasNoSayInARelease) {
  const std::filesystem::path folder = testing::TempDir() + "other_shaders";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "frame.glsl") << "this is no shader\n";
  setenv("TERRELLA_SHADER_DIR", folder.c_str(), 1);
  EXPECT_GT(shader_text("frame.glsl").value_or("").size(), 100U);
  unsetenv("TERRELLA_SHADER_DIR");
  std::filesystem::remove_all(folder);
}
#endif

}  // namespace
}  // namespace terrella::test
