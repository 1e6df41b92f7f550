// Error beside time of the four texturing modes, view by view, as a Markdown table.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/frame_timing.h"
#include "ground_truth/judge.h"
#include "ground_truth/truth_cache.h"
#include "render/offscreen.h"

#include <epoxy/gl.h>

namespace {

using namespace terrella;
using truth::TruthCamera;
using truth::Zone;

constexpr Viewport kSize{1024, 1024};
constexpr std::chrono::seconds kLongestSettling{120};
constexpr double kFourRadii_m = 3.0 * 6378137.0;

struct Mode {
  const char* name;
  Texturing texturing;
};
// `vertex` first: the others' times are ratios to it.
constexpr std::array<Mode, 4> kModes = {Mode{"vertex", Texturing::vertex}, Mode{"paper", Texturing::paper},
                                        Mode{"exact", Texturing::exact}, Mode{"auto", Texturing::automatic}};

struct TableView {
  const char* name;
  TruthCamera camera;
  Zone zone;
};

TruthCamera over(double lat_deg, double lon_deg, double height_m) { return {.eye = {lat_deg, lon_deg, height_m}}; }

std::vector<TableView> table_views() {
  return {{"mid latitude, 6000 km", over(30, 20, 6e6), Zone::all},
          {"antimeridian, 6000 km", over(0, 180, 6e6), Zone::antimeridian},
          {"beside the pole, 6000 km", over(89.9, 0, 6e6), Zone::pole},
          {"beside the pole, 1500 km", over(88, 10, 1.5e6), Zone::pole},
          {"pole, tilted 45°", {{80, 180, 1.2e6}, 0, -45, 40}, Zone::pole_clear},
          {"low oblique, 300 km", {{46, 7, 3e5}, 30, -20, 45}, Zone::clear},
          {"four radii, 0°N 20°E", over(0, 20, kFourRadii_m), Zone::mid_latitudes},
          {"four radii, pole", over(90, 0, kFourRadii_m), Zone::pole}};
}

Camera as_globe_camera(const TruthCamera& c) {
  return {
      .eye = {.lat = Angle::degrees(c.eye.lat_deg), .lon = Angle::degrees(c.eye.lon_deg), .height_m = c.eye.height_m},
      .heading = Angle::degrees(c.heading_deg),
      .pitch = Angle::degrees(c.pitch_deg),
      .fov_y = Angle::degrees(c.fov_deg)};
}

truth::Picture shot(const OffscreenTarget& target) {
  const std::vector<std::uint8_t> rgba = target.read();
  truth::Picture picture{kSize.width_px, kSize.height_px, {}};
  for (std::size_t k = 0; k < rgba.size(); k += 4) {
    picture.rgb.insert(picture.rgb.end(), {rgba[k], rgba[k + 1], rgba[k + 2]});
  }
  return picture;
}

struct Arguments {
  std::string tiles, picture, cache;
  int rounds = 15;
};

class Table {
 public:
  explicit Table(const Arguments& arguments)
      : arguments_(arguments), source_(truth::make_source(truth::read_picture(arguments.picture))), target_(kSize) {
    for (const Mode& mode : kModes) globes_.push_back(bench::open_globe(arguments.tiles, mode.texturing, true));
  }

  void print_line(const TableView& view) {
    const truth::TruthImage truth = truth::cast_cached(
        source_, {}, {}, view.camera, {.width = kSize.width_px, .height = kSize.height_px}, arguments_.cache);
    std::string line = fmt::format("| {} | {} |", view.name, truth::zone_name(view.zone));
    std::vector<bench::Subject> subjects;
    for (std::size_t m = 0; m < kModes.size(); ++m) {
      Globe& globe = *globes_[m];
      settle(globe, view);
      line += fmt::format(" {:.2f} |", truth::judge(shot(target_), truth, {}, {}, {})[view.zone].rms);
      subjects.push_back({kModes[m].name, [&globe, this] { globe.render(target_.framebuffer(), kSize); }});
    }
    bench::time_frames(subjects, arguments_.rounds);
    const double ms = bench::median(subjects[0].ms), cpu_ms = bench::median(subjects[0].cpu_ms);
    line += fmt::format(" {:.1f} ms, {:.1f} ms |", cpu_ms, ms);
    for (std::size_t m = 1; m < subjects.size(); ++m) {
      line += fmt::format(" {:.2f}, {:.2f} |", bench::median(subjects[m].cpu_ms) / cpu_ms,
                          bench::median(subjects[m].ms) / ms);
    }
    fmt::print("{}\n", line);
    std::fflush(stdout);
  }

 private:
  void settle(Globe& globe, const TableView& view) {
    globe.set_camera(as_globe_camera(view.camera));
    const auto deadline = std::chrono::steady_clock::now() + kLongestSettling;
    if (globe.render_until_settled(target_.framebuffer(), kSize, deadline)) return;
    throw std::runtime_error(fmt::format("{}: not settled after {} s", view.name, kLongestSettling.count()));
  }

  const Arguments& arguments_;
  truth::Source source_;
  OffscreenTarget target_;
  std::vector<std::unique_ptr<Globe>> globes_;
};

void print_table(const Arguments& arguments) {
  Table table(arguments);
  fmt::print(
      "{}; RMS in 8-bit levels against 64 rays a pixel. Times are medians of {} settled frames of 1024×1024, unlit:\n"
      "processor time, then wall time; for the modes after `vertex` as ratios to it.\n\n"
      "| view | zone | RMS vertex | paper | exact | auto | frame vertex | paper | exact | auto |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n",
      reinterpret_cast<const char*>(glGetString(GL_RENDERER)), arguments.rounds);
  for (const TableView& view : table_views()) table.print_line(view);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Error beside time of the four texturing modes, as a Markdown table");
  Arguments arguments;
  app.add_option("--tiles", arguments.tiles, "tile set cut from the picture, PNG tiles")->required();
  app.add_option("--picture", arguments.picture, "the picture itself: the noise planet")->required();
  app.add_option("--cache", arguments.cache, "folder that remembers the ground truth's pictures");
  app.add_option("--rounds", arguments.rounds, "frames of each mode")->check(CLI::Range(1, 1000));
  CLI11_PARSE(app, argc, argv);
  const auto context = HeadlessContext::create();
  if (!context) return fmt::print(stderr, "{}\n", context.error().message), 1;
  try {
    print_table(arguments);
  } catch (const std::exception& error) {
    return fmt::print(stderr, "{}\n", error.what()), 1;
  }
  return 0;
}
