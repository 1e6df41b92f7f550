// Frame cost of the globe as a ratio to paper 1's plain sphere, both drawn in turn in one process.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "bench/frame_timing.h"
#include "bench/paper_sphere.h"
#include "ground_truth/picture.h"
#include "render/offscreen.h"

#include <epoxy/gl.h>

namespace {

using namespace terrella;
using bench::median;
using bench::open_globe;
using bench::Subject;
using Clock = std::chrono::steady_clock;

constexpr Viewport kSize{1024, 1024};

Camera camera_at(double lat_deg, double lon_deg, double radii) {
  Camera camera;
  camera.eye = {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = (radii - 1.0) * 6378137.0};
  return camera;
}

void measure(const std::string& view, std::vector<Subject> subjects, int rounds) {
  bench::time_frames(subjects, rounds);
  const double base = median(subjects.front().ms), cpu_base = median(subjects.front().cpu_ms);
  for (const Subject& subject : subjects) {
    fmt::print("{:<6} {:<22} wall {:7.2f} ms  ratio {:5.2f}   processor {:7.2f} ms  ratio {:5.2f}\n", view,
               subject.name, median(subject.ms), median(subject.ms) / base, median(subject.cpu_ms),
               median(subject.cpu_ms) / cpu_base);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Frame cost of the globe against paper 1's plain sphere, in one run");
  std::string tile_set, picture;
  int rounds = 15;
  app.add_option("--tiles", tile_set, "tile set for the globe")->required();
  app.add_option("--picture", picture, "picture for the plain sphere, 8192x4096 in the paper")->required();
  std::string only;
  app.add_option("--rounds", rounds, "frames of each subject");
  app.add_option("--only", only, "draw subjects whose name contains this and no others, for a profiler");
  CLI11_PARSE(app, argc, argv);
  const auto context = HeadlessContext::create();
  if (!context) return fmt::print(stderr, "{}\n", context.error().message), 1;
  fmt::print("{}\n", reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
  const bench::PaperSphere sphere(truth::read_picture(picture));
  const OffscreenTarget target(kSize);
  const auto automatic = open_globe(tile_set, Texturing::automatic, true),
             vertex = open_globe(tile_set, Texturing::vertex, true),
             lit = open_globe(tile_set, Texturing::automatic, false),
             paper = open_globe(tile_set, Texturing::paper, true), exact = open_globe(tile_set, Texturing::exact, true);
  for (const auto& [name, lat, lon] : {std::tuple{"side", 0.0, 20.0}, std::tuple{"pole", 90.0, 0.0}}) {
    const Camera camera = camera_at(lat, lon, 4.0);
    const auto subject = [&](const char* label, Globe& g) {
      g.set_camera(camera);
      g.render_until_settled(target.framebuffer(), kSize, Clock::now() + std::chrono::seconds(60));
      return Subject{label, [&g, &target] { g.render(target.framebuffer(), kSize); }};
    };
    const truth::TruthCamera same{.eye = {.lat_deg = lat, .lon_deg = lon, .height_m = camera.eye.height_m}};
    std::vector<Subject> subjects = {Subject{"plain sphere (paper)", [&] { sphere.draw(same, 6378137.0); }},
                                     subject("vertex, unlit", *vertex),
                                     subject("auto, unlit", *automatic),
                                     subject("auto, lit", *lit),
                                     subject("paper, unlit", *paper),
                                     subject("exact, unlit", *exact)};
    std::erase_if(subjects, [&only](const Subject& s) { return s.name.find(only) == std::string::npos; });
    if (!subjects.empty()) measure(name, std::move(subjects), rounds);
  }
  return 0;
}
