// Two globes of two bodies in one context: neither knows of the other, and nothing is left of them.
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <map>

#include "tests/gl/gl_fixture.h"
#include "tests/scene/patch_test_support.h"
#include "tests/support/leaks.h"

namespace terrella::test {
namespace {

constexpr Viewport kHalf{48, 48};
constexpr Viewport kBothHalves{96, 48};

/// GL objects of each kind that there are.
std::map<std::string, int> objects_there() {
  constexpr GLuint kMostNames = 20000;
  std::map<std::string, int> there;
  for (GLuint name = 1; name < kMostNames; ++name) {
    there["buffers"] += glIsBuffer(name);
    there["framebuffers"] += glIsFramebuffer(name);
    there["programs"] += glIsProgram(name);
    there["samplers"] += glIsSampler(name);
    there["shaders"] += glIsShader(name);
    there["textures"] += glIsTexture(name);
    there["vertex arrays"] += glIsVertexArray(name);
  }
  return there;
}

class TwoGlobes : public GlTest {
 protected:
  static std::unique_ptr<Globe> body_globe(const Body& body, const Color& color) {
    GlobeOptions options;
    options.body = body;
    options.workers = 1;
    auto globe = make_globe(options, one_colour({.tile_px = 16, .max_level = 1}, color));
    globe->set_camera(camera_at(10, 20, 3.0 * body.ellipsoid.a_m()));
    return globe;
  }
  static std::unique_ptr<Globe> earth_globe() { return body_globe(earth(), {60, 120, 200}); }
  static std::unique_ptr<Globe> moon_globe() { return body_globe(*parse_body("moon"), {150, 150, 140}); }
};

TEST_F(TwoGlobes, SideBySideEachLooksAsItDoesAlone) {
  const auto alone = [this](std::unique_ptr<Globe> globe) {
    settle(*globe, kHalf);
    return picture();
  };
  const Picture earth_alone = alone(earth_globe()), moon_alone = alone(moon_globe());
  const auto earth = earth_globe(), moon = moon_globe();
  const OffscreenTarget window(kBothHalves);
  for (int frame = 0; frame < 200 && !(frame > 2 && earth->settled() && moon->settled()); ++frame) {
    earth->render(window.framebuffer(), kHalf);
    moon->render(window.framebuffer(), kHalf, {kHalf.width_px, 0});
  }
  const Picture both{kBothHalves, window.read()};
  int off = 0;
  for (int y = 0; y < kHalf.height_px; ++y) {
    for (int x = 0; x < kHalf.width_px; ++x) {
      off += both.at(x, y) != earth_alone.at(x, y) ? 1 : 0;
      off += both.at(x + kHalf.width_px, y) != moon_alone.at(x, y) ? 1 : 0;
    }
  }
  EXPECT_EQ(off, 0);
}

TEST_F(TwoGlobes, MadeAndEndedAHundredTimesTheyLeaveNothing) {
  const OffscreenTarget window(kBothHalves);
  const auto before = objects_there();
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < 100; ++k) {
    const auto earth = earth_globe(), moon = moon_globe();
    if (k % 10 != 0) continue;  // a software rasteriser compiles what is drawn: most of the time
    earth->render(window.framebuffer(), kHalf);
    moon->render(window.framebuffer(), kHalf, {kHalf.width_px, 0});
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  RecordProperty("seconds", std::to_string(took.count()));
  EXPECT_EQ(objects_there(), before);
  // In a process of its own, as CTest runs it: of a context that is gone Mesa keeps what nothing points at.
  EXPECT_FALSE(has_leaked());
}

}  // namespace
}  // namespace terrella::test
