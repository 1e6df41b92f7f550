// Frame cost of the globe as a ratio to paper 1's plain sphere, both drawn in turn in one process.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "bench/paper_sphere.h"
#include "engine/globe.h"
#include "ground_truth/picture.h"
#include "render/offscreen.h"
#include "streaming/tile_source.h"

#include <epoxy/gl.h>

namespace {

using namespace terrella;
using Clock = std::chrono::steady_clock;

constexpr Viewport kSize{1024, 1024};

struct Subject {
  std::string name;
  std::function<void()> draw;
  std::vector<double> ms;
  std::vector<double> cpu_ms;  ///< processor time of the whole process: what other programs do does not change it
};

Camera camera_at(double lat_deg, double lon_deg, double radii) {
  Camera camera;
  camera.eye = {.lat = Angle::degrees(lat_deg), .lon = Angle::degrees(lon_deg), .height_m = (radii - 1.0) * 6378137.0};
  return camera;
}

std::unique_ptr<Globe> globe(const std::string& tile_set, Texturing texturing, bool unlit) {
  GlobeOptions options;
  options.texturing = texturing;
  options.unlit = unlit;
  options.upload_bytes_per_frame = options.gpu_bytes;
  options.upload_time_per_frame = std::chrono::seconds(1);
  Result<std::unique_ptr<TileSource>> source = open_tile_set(tile_set);
  if (!source) throw std::runtime_error(source.error().message);
  Result<std::unique_ptr<Globe>> made = Globe::create(options, std::shared_ptr<TileSource>(std::move(*source)));
  if (!made) throw std::runtime_error(made.error().message);
  return std::move(*made);
}

double processor_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void measure(const std::string& view, std::vector<Subject> subjects, int rounds) {
  for (int round = -2; round < rounds; ++round) {
    for (Subject& subject : subjects) {
      glFinish();
      const auto start = Clock::now();
      const double cpu_start = processor_ms();
      subject.draw();
      glFinish();
      const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
      if (round < 0) continue;
      subject.ms.push_back(ms);
      subject.cpu_ms.push_back(processor_ms() - cpu_start);
    }
  }
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
  const auto automatic = globe(tile_set, Texturing::automatic, true), vertex = globe(tile_set, Texturing::vertex, true),
             lit = globe(tile_set, Texturing::automatic, false), paper = globe(tile_set, Texturing::paper, true),
             exact = globe(tile_set, Texturing::exact, true);
  for (const auto& [name, lat, lon] : {std::tuple{"side", 0.0, 20.0}, std::tuple{"pole", 90.0, 0.0}}) {
    const Camera camera = camera_at(lat, lon, 4.0);
    const auto subject = [&](const char* label, Globe& g) {
      g.set_camera(camera);
      g.render_until_settled(target.framebuffer(), kSize, Clock::now() + std::chrono::seconds(60));
      return Subject{label, [&g, &target] { g.render(target.framebuffer(), kSize); }, {}, {}};
    };
    const truth::TruthCamera same{.eye = {.lat_deg = lat, .lon_deg = lon, .height_m = camera.eye.height_m}};
    std::vector<Subject> subjects = {Subject{"plain sphere (paper)", [&] { sphere.draw(same, 6378137.0); }, {}, {}},
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
