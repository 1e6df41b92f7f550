#include <epoxy/gl.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <string>
#include <vector>

#include "bench/headless_gl.h"
#include "bench/paper_sphere.h"
#include "ground_truth/noise_planet.h"

namespace {

using namespace terrella;
constexpr double kRadius_m = 6371000.0;

struct Arguments {
  std::string picture, out;
  std::vector<double> camera{0.0, 0.0, 3.0 * kRadius_m, 0.0, -90.0, 40.0};
  int frames = 20;
};

void run(const Arguments& arguments) {
  const bench::HeadlessGl gl;
  const std::vector<double>& c = arguments.camera;
  const truth::TruthCamera camera{{c[0], c[1], c[2]}, c[3], c[4], c[5]};
  const bench::PaperSphere sphere(arguments.picture.empty() ? truth::noise_planet({})
                                                            : truth::read_picture(arguments.picture));
  const double frame_ms = sphere.frame_ms(camera, kRadius_m, arguments.frames);
  fmt::print("{:.2f} ms a frame ({})\n", frame_ms, reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
  if (!arguments.out.empty()) truth::write_png(sphere.read_back(), arguments.out);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Draws and times the plain sphere of paper 1 (n = 48, one trilinear texture, 1024x1024), radius 6371 km.\n"
      "Example: paper_sphere --picture noise.png --camera 90,0,19113000,0,-90,40 --out pole.png"};
  Arguments arguments;
  app.add_option("--picture", arguments.picture,
                 "equirectangular PNG or JPEG; the 8192x4096 noise planet if not given");
  app.add_option("--camera", arguments.camera, "LAT,LON,ALT,HEADING,PITCH,FOV; from four radii over 0,0 if not given")
      ->delimiter(',')
      ->expected(6);
  app.add_option("--frames", arguments.frames, "frames to time")->check(CLI::Range(1, 10000))->capture_default_str();
  app.add_option("--out", arguments.out, "write the picture as this PNG");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    run(arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
