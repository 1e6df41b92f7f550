// Cost of objects: an opaque globe by itself, and with 100,000 spheres over it; a translucent one by itself, and with
// 100,000 spheres under it. In turn in one run, as whole frames of the globe.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "apps/bench/frame_timing.h"
#include "render/gl/offscreen.h"

#include <epoxy/gl.h>

namespace {

using namespace terrella;
using bench::median;
using bench::Subject;
using Clock = std::chrono::steady_clock;

constexpr Viewport kSize{1024, 1024};

ObjectScene spheres(int count, double radius_m, double lowest_m, double highest_m) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> sine(-1.0, 1.0), lon(-180.0, 180.0), height(lowest_m, highest_m);
  ObjectScene scene;
  for (int k = 0; k < count; ++k) {
    const Geodetic place{
        .lat = Angle::radians(std::asin(sine(random))), .lon = Angle::degrees(lon(random)), .height_m = height(random)};
    scene.points.push_back({.place = place, .radius_m = radius_m});
  }
  return scene;
}

struct Spread {
  double low, middle, high;
};

/// Median and quartiles of the ratios of two subjects' frames, round by round.
Spread ratios(const std::vector<double>& of, const std::vector<double>& to) {
  std::vector<double> all;
  for (std::size_t k = 0; k < of.size(); ++k) all.push_back(of[k] / to[k]);
  std::sort(all.begin(), all.end());
  return {all[all.size() / 4], all[all.size() / 2], all[all.size() * 3 / 4]};
}

void print(const Subject& subject, const Subject& base) {
  const auto column = [](const std::vector<double>& ms, const std::vector<double>& base_ms) {
    const Spread r = ratios(ms, base_ms);
    return fmt::format("{:7.2f} ms  ratio {:5.2f} ({:.2f} to {:.2f})", median(ms), r.middle, r.low, r.high);
  };
  fmt::print("{:<40} wall {}   processor {}\n", subject.name, column(subject.ms, base.ms),
             column(subject.cpu_ms, base.cpu_ms));
}

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
  std::vector<std::unique_ptr<Globe>> globes;
  std::vector<Subject> subjects;
  const auto add = [&](const std::string& name, double alpha, const ObjectScene& scene) {
    globes.push_back(bench::open_globe(tile_set, Texturing::automatic, false));
    Globe& globe = *globes.back();
    Camera camera;
    camera.eye = {.lat = Angle::degrees(10.0), .lon = Angle::degrees(20.0), .height_m = 3.0 * 6378137.0};
    globe.set_camera(camera);
    globe.set_surface({.alpha = alpha});
    if (!scene.empty() && !globe.add_objects(scene)) return;
    globe.render_until_settled(target.framebuffer(), kSize, Clock::now() + std::chrono::seconds(60));
    subjects.push_back({name, [&globe, &target] { globe.render(target.framebuffer(), kSize); }});
  };
  add("opaque globe", 1.0, {});
  for (const double km : {5.0, 20.0, 40.0}) {
    add(fmt::format("and {} of {} km over it", count, km), 1.0, spheres(count, 1e3 * km, 1.0e3, 700.0e3));
  }
  add(fmt::format("and {} of 5 km under it", count), 1.0, spheres(count, 5.0e3, -700.0e3, -1.0e3));
  add("translucent globe", 0.5, {});
  for (const double km : {5.0, 20.0, 40.0}) {
    add(fmt::format("and {} of {} km under it", count, km), 0.5, spheres(count, 1e3 * km, -700.0e3, -1.0e3));
  }
  bench::time_frames(subjects, rounds);
  for (const Subject& subject : subjects) print(subject, subjects.front());
  return 0;
}
