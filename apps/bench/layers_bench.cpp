#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "apps/bench/benches.h"
#include "apps/bench/frame_timing.h"
#include "apps/bench/sources/wave_numbers.h"
#include "apps/bench/value_of.h"
#include "apps/open_scene/sky_data.h"
#include "apps/process/data_dir.h"
#include "render/gl/offscreen.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella::bench {
namespace {

constexpr Camera kWholeDisc{
    .eye = {.lat = Angle::degrees(10.0), .lon = Angle::degrees(20.0), .height_m = 3.0 * 6378137.0}};
constexpr const char* kBare = "bare";

/// A set that has pictures of another one in a twentieth of the view.
class TwentiethSource : public TileSource {
 public:
  explicit TwentiethSource(std::shared_ptr<TileSource> all) : all_(std::move(all)), info_(all_->info()) {
    info_.grid.bounds = {.west = Angle::degrees(6.0),
                         .south = Angle::degrees(-2.0),
                         .east = Angle::degrees(30.0),
                         .north = Angle::degrees(18.0)};
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override { return all_->read(id); }

 private:
  std::shared_ptr<TileSource> all_;
  TileSetInfo info_;
};

std::shared_ptr<TileSource> painted_earth() { return value_of(open_tile_set(data_file("earth.gpkg").string())); }

/// Image layers over the bare globe. `limit`: the largest ratio to the bare globe.
struct Stack {
  std::string name;
  std::function<void(Globe&)> add;
  double limit = kNoFigure;
};

void add_layer(Globe& globe, std::shared_ptr<TileSource> source, const ImageLook& look) {
  static_cast<void>(value_of(globe.add_imagery(std::move(source), look)));
}

std::function<void(Globe&)> half_opaque(int layers) {
  return [layers](Globe& globe) {
    for (int k = 1; k < layers; ++k) add_layer(globe, painted_earth(), {.opacity = 0.5});
  };
}

std::vector<Stack> stacks() {
  const auto opaque_over_three = [](Globe& globe) {
    half_opaque(3)(globe);
    add_layer(globe, painted_earth(), {});
  };
  const auto two_grids = [](Globe& globe) {
    for (int k = 0; k < 3; ++k) add_layer(globe, k == 1 ? painted_earth() : wave_pictures(), {.opacity = 0.5});
  };
  return {{kBare, [](Globe&) {}},
          {"2 layers", half_opaque(2), 1.55},
          {"4 layers", half_opaque(4), 2.6},
          {"8 layers", half_opaque(8), 4.8},
          {"4 layers of two grids", two_grids},
          {"an opaque layer over three", opaque_over_three, 1.1},
          {"an overlay over a twentieth",
           [](Globe& globe) { add_layer(globe, std::make_shared<TwentiethSource>(painted_earth()), {.opacity = 0.5}); },
           1.1}};
}

GlobeOptions in_light(const std::string& light) {
  GlobeOptions options;
  options.unlit = light == "unlit";
  if (light != "sky and air") return options;
  SkyData data = load_sky_data();
  if (!data.problems.empty()) throw std::runtime_error(data.problems.front());
  options.sky = true;
  options.stars = std::move(data.stars);
  return options;
}

void measure_light(const std::string& light, const BenchOptions& options, Report& report) {
  const bool quick = options.effort == Effort::quick;
  const Viewport size = quick ? Viewport{192, 192} : Viewport{1024, 1024};
  OffscreenTarget target(size);
  std::vector<std::unique_ptr<Globe>> globes;
  std::vector<Subject> subjects;
  const std::vector<Stack> all = stacks();
  for (const Stack& stack : all) {
    options.progress(fmt::format("{}: {}", light, stack.name));
    GlobeOptions globe_options = in_light(light);
    globe_options.upload_bytes_per_frame = globe_options.gpu_bytes;
    globe_options.upload_time_per_frame = std::chrono::seconds(1);
    Globe& globe = *globes.emplace_back(value_of(Globe::create(globe_options)));
    add_layer(globe, painted_earth(), {});
    stack.add(globe);
    globe.set_camera(kWholeDisc);
    const auto late = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    if (!globe.render_until_settled(target.framebuffer(), size, late)) {
      throw std::runtime_error("a globe has not settled in two minutes");
    }
    subjects.push_back({stack.name, [&globe, &target, size] { globe.render(target.framebuffer(), size); }});
  }
  time_frames(subjects, quick ? 2 : 15);
  const Subject& bare = subjects.front();
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Subject& s = subjects[k];
    report.rows.push_back({light, s.name, median(s.cpu_ms), median(s.ms), median_ratio(s.cpu_ms, bare.cpu_ms),
                           median_ratio(s.ms, bare.ms), static_cast<double>(globes[k]->last_frame().draw_calls)});
    if (std::isnan(all[k].limit) || light == "unlit") continue;
    report.findings.push_back({fmt::format("{}, {}", s.name, light), median_ratio(s.whole_ms, bare.whole_ms),
                               quick ? kNoFigure : all[k].limit, "of the bare globe"});
  }
}

}  // namespace

Result<Report> bench_layers(const BenchOptions& options) {
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  Report report{.name = "layers",
                .title = "Image layers, as ratios to the bare globe",
                .facts = {{"renderer", renderer_name()},
                          {"time", timing_method()},
                          {"picture", "the included Earth from four radii, over itself at half opacity"}},
                .columns = {{"light", ""},
                            {"layers", ""},
                            {"cpu", "ms of processor", 1},
                            {"time", "ms", 1},
                            {"cpu_ratio", "of the bare globe"},
                            {"time_ratio", "of the bare globe"},
                            {"calls", "draw calls", 0}}};
  report.plots = {{.title = "cost of layers", .x = "time", .y = "cpu_ratio", .series = "light", .lines = false}};
  try {
    for (const char* light : {"lit", "sky and air", "unlit"}) {
      if (options.wants(light)) measure_light(light, options, report);
    }
  } catch (const std::exception& error) {
    return Error{error.what()};
  }
  return report;
}

}  // namespace terrella::bench
