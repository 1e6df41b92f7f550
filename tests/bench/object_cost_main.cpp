// What objects cost: an opaque globe by itself and with 100,000 spheres besides, in turn in one run; the spheres
// without an inner sphere that hides those of the far side, and with it.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <random>
#include <string>
#include <vector>

#include "apps/bench/frame_timing.h"
#include "render/frame_block.h"
#include "render/object_pass.h"
#include "render/offscreen.h"
#include "scene/patch_mesh.h"

#include <epoxy/gl.h>

namespace {

using namespace terrella;
using bench::median;
using bench::Subject;
using Clock = std::chrono::steady_clock;

constexpr Viewport kSize{1024, 1024};

ObjectScene spheres(int count, double radius_m) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> sine(-1.0, 1.0), lon(-180.0, 180.0), height(-700.0e3, -1.0e3);
  ObjectScene scene;
  for (int k = 0; k < count; ++k) {
    const Geodetic place{
        .lat = Angle::radians(std::asin(sine(random))), .lon = Angle::degrees(lon(random)), .height_m = height(random)};
    scene.points.push_back({.place = place, .radius_m = radius_m});
  }
  return scene;
}

/// A picture with depth and the uniform block that objects need.
class ObjectTarget {
 public:
  ObjectTarget()
      : color_(gl::make_texture(GL_TEXTURE_2D)),
        depth_(gl::make_texture(GL_TEXTURE_2D)),
        framebuffer_(gl::make_framebuffer()),
        frame_block_(gl::make_buffer()) {
    glTextureStorage2D(color_.name(), 1, GL_RGBA8, kSize.width_px, kSize.height_px);
    glTextureStorage2D(depth_.name(), 1, GL_DEPTH_COMPONENT32F, kSize.width_px, kSize.height_px);
    glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, color_.name(), 0);
    glNamedFramebufferTexture(framebuffer_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
    glNamedBufferStorage(frame_block_.name(), sizeof(FrameBlock), nullptr, GL_DYNAMIC_STORAGE_BIT);
  }

  void draw(const ObjectPass& pass, const View& view, double hiding_radius_m) const {
    const SplitPosition eye = split_position(view.eye.xyz_m);
    FrameBlock block{};
    block.view_from_ecef = glm::mat4(glm::mat3(view_from_ecef_rotation(view)));
    block.eye_high_ecef = glm::vec4(eye.high, 0.0F);
    block.eye_low_ecef = glm::vec4(eye.low, 0.0F);
    block.clip_scale = glm::vec4(1.0 / view.tan_half_fov_y, 1.0 / view.tan_half_fov_y, 1.0e3, 1.0e8);
    block.sun_ecef = glm::vec4(1.0F, 0.0F, 0.0F, 1.0F);
    glNamedBufferSubData(frame_block_.name(), 0, sizeof(block), &block);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_block_.name());
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, kSize.width_px, kSize.height_px);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glClearDepth(0.0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    pass.draw(ObjectPart::underground, kSize, ObjectChoice::all, hiding_radius_m);
  }

 private:
  gl::Texture color_, depth_;
  gl::Framebuffer framebuffer_;
  gl::Buffer frame_block_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Cost of 100,000 spheres beside an opaque globe, in one run");
  std::string tile_set;
  int rounds = 15, count = 100'000;
  app.add_option("--tiles", tile_set, "tile set for the globe")->required();
  app.add_option("--rounds", rounds, "frames of each subject");
  app.add_option("--count", count, "number of spheres");
  CLI11_PARSE(app, argc, argv);
  const auto context = HeadlessContext::create();
  if (!context) return fmt::print(stderr, "{}\n", context.error().message), 1;
  fmt::print("{}\n", reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
  const OffscreenTarget target(kSize);
  const ObjectTarget objects;
  const auto globe = bench::open_globe(tile_set, Texturing::automatic, false);
  Camera camera;
  camera.eye = {.lat = Angle::degrees(10.0), .lon = Angle::degrees(20.0), .height_m = 3.0 * 6378137.0};
  globe->set_camera(camera);
  globe->render_until_settled(target.framebuffer(), kSize, Clock::now() + std::chrono::seconds(60));
  const auto draw_globe = [&] { globe->render(target.framebuffer(), kSize); };
  std::vector<Subject> subjects{Subject{"globe", draw_globe}};
  std::vector<std::unique_ptr<ObjectPass>> passes;
  for (const double radius_km : {5.0, 20.0, 40.0}) {
    auto pass = ObjectPass::create(DepthMode::reversed);
    if (!pass) return fmt::print(stderr, "{}\n", pass.error().message), 1;
    (*pass)->set_objects(spheres(count, 1e3 * radius_km), earth().ellipsoid);
    passes.push_back(std::move(*pass));
    const ObjectPass* drawn = passes.back().get();
    for (const double hiding_km : {0.0, 5378.0}) {
      subjects.push_back({fmt::format("and {} of {} km{}", count, radius_km, hiding_km > 0.0 ? ", inner sphere" : ""),
                          [&, drawn, hiding_km] {
                            draw_globe();
                            objects.draw(*drawn, globe->view(kSize), 1e3 * hiding_km);
                          }});
    }
  }
  bench::time_frames(subjects, rounds);
  for (const Subject& subject : subjects) {
    fmt::print("{:<34} wall {:7.2f} ms  ratio {:5.2f}   processor {:7.2f} ms  ratio {:5.2f}\n", subject.name,
               median(subject.ms), median(subject.ms) / median(subjects.front().ms), median(subject.cpu_ms),
               median(subject.cpu_ms) / median(subjects.front().cpu_ms));
  }
  return 0;
}
