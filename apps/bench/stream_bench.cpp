#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/bench/benches.h"
#include "apps/bench/frame_timing.h"
#include "apps/bench/shots.h"
#include "apps/bench/sources/counting_source.h"
#include "apps/bench/test_planet.h"
#include "apps/bench/truth/masked_error.h"
#include "geo/body.h"
#include "streaming/sets/open_tile_set.h"

#include <epoxy/gl.h>

namespace terrella::bench {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

constexpr std::chrono::seconds kLongest{120};
constexpr double kMostOfCesium = 0.8;

/// `cesium_requests`: those of CesiumJS for the same picture of the same tiles, 1024×1024.
struct StreamView {
  const char* name;
  truth::TruthCamera camera;
  int cesium_requests;
};

std::vector<StreamView> stream_views(Effort effort) {
  std::vector<StreamView> views = {{"mid latitude, 6000 km", {.eye = {30, 20, 6e6}}, 54},
                                   {"beside the pole, 6000 km", {.eye = {89.9, 0, 6e6}}, 110}};
  if (effort == Effort::quick) return views;
  views.push_back({"antimeridian, 6000 km", {.eye = {0, 180, 6e6}}, 50});
  views.push_back({"beside the pole, 1500 km", {.eye = {88, 10, 1.5e6}}, 62});
  views.push_back({"pole, tilted 45°", {{80, 180, 1.2e6}, 0, -45, 40}, 84});
  views.push_back({"low oblique, 300 km", {{46, 7, 3e5}, 30, -20, 45}, 13});
  return views;
}

/// Totals at the end of a frame.
struct Moment {
  double ms = 0.0;  ///< since the view was requested
  int frames = 0;
  std::int64_t requests = 0, bytes = 0;
  int tiles = 0, missing = 0;
  truth::Picture shown;
  [[nodiscard]] double there() const { return tiles == 0 ? 0.0 : 1.0 - static_cast<double>(missing) / tiles; }
};

class Streamer {
 public:
  Streamer(const BenchOptions& options, TestPlanet planet)
      : options_(options),
        side_px_(options.effort == Effort::quick ? 192 : 1024),
        rays_(options.effort == Effort::quick ? 4 : 8),
        viewport_{side_px_, side_px_},
        planet_(std::move(planet)),
        target_(viewport_) {}

  void measure(const StreamView& view, Report& report) {
    options_.progress(view.name);
    const truth::TruthImage truth =
        truth::cast_cached(planet_.source, {}, as_spheroid(earth().ellipsoid), view.camera,
                           {.width = side_px_, .height = side_px_, .rays_per_side = rays_}, truth_folder(options_));
    auto opened = open_tile_set(planet_.tiles);
    if (!opened) throw std::runtime_error(opened.error().message);
    source_ = std::make_shared<CountingSource>(*std::move(opened));
    GlobeOptions globe_options;
    globe_options.unlit = true;
    auto globe = Globe::create(globe_options, source_);
    if (!globe) throw std::runtime_error(globe.error().message);
    add_rows(report, view, "cold", come_to(**globe, view.camera), truth);
    report.findings.push_back({fmt::format("requests of {}, to CesiumJS's", view.name),
                               static_cast<double>(source_->requests()) / view.cesium_requests,
                               options_.effort == Effort::quick ? kNoFigure : kMostOfCesium});
    truth::TruthCamera away = view.camera;
    away.eye.lat_deg = -away.eye.lat_deg;
    away.eye.lon_deg += 120.0;
    settle(**globe, away, target_, viewport_);
    add_rows(report, view, "back again", come_to(**globe, view.camera), truth);
  }

 private:
  /// Draws frames until the view has settled. Returns the notable ones: the first, the first without a hole, a quarter,
  /// half and three quarters of the tiles, and the last.
  std::vector<Moment> come_to(Globe& globe, const truth::TruthCamera& camera) {
    const std::int64_t requests = source_->requests(), bytes = source_->bytes();
    const auto start = Clock::now();
    std::vector<Moment> moments;
    globe.set_camera(as_globe_camera(camera));
    double next_share = 0.0;
    for (int frames = 1;; ++frames) {
      const FrameStats stats = globe.render(target_.framebuffer(), viewport_);
      glFinish();
      Moment now{.ms = Milliseconds(Clock::now() - start).count(),
                 .frames = frames,
                 .requests = source_->requests() - requests,
                 .bytes = source_->bytes() - bytes,
                 .tiles = stats.tiles_wanted,
                 .missing = stats.tiles_pending,
                 .shown = {}};
      const bool last = globe.settled();
      if (!last && Clock::now() - start > kLongest) throw std::runtime_error("a view has not settled in two minutes");
      if (last || (stats.patches_uncovered == 0 && now.there() >= next_share)) {
        while (next_share <= now.there()) next_share += 0.25;
        now.shown = shot(target_, viewport_);
        moments.push_back(std::move(now));
      }
      if (last) return moments;
    }
  }

  void add_rows(Report& report, const StreamView& view, const char* visit, const std::vector<Moment>& moments,
                const truth::TruthImage& truth) {
    const truth::Mask clear = truth::clear_mask(truth);
    for (std::size_t k = 0; k < moments.size(); ++k) {
      const Moment& m = moments[k];
      const bool last = k + 1 == moments.size();
      if (k == 0 && std::string_view(visit) == "cold") cold_requests_ = moments.back().requests;
      const double seconds = 1e-3 * m.ms;
      report.rows.push_back({std::string(view.name), std::string(visit),
                             std::string(last     ? "settled"
                                         : k == 0 ? "no hole"
                                                  : "on the way"),
                             m.ms, std::int64_t{m.frames}, m.requests, 1e-6 * static_cast<double>(m.bytes),
                             static_cast<double>(m.requests) / seconds,
                             100.0 * (1.0 - static_cast<double>(m.requests) /
                                                static_cast<double>(std::max<std::int64_t>(1, cold_requests_))),
                             std::int64_t{m.tiles}, 100.0 * m.there(), truth::masked_error(m.shown, truth, clear).rms});
    }
  }

  const BenchOptions& options_;
  int side_px_, rays_;
  Viewport viewport_;
  TestPlanet planet_;
  OffscreenTarget target_;
  std::shared_ptr<CountingSource> source_;
  std::int64_t cold_requests_ = 0;
};

std::vector<Column> stream_columns() {
  return {{"view", ""},
          {"visit", ""},
          {"moment", ""},
          {"time", "ms since the view was requested", 0},
          {"frames", ""},
          {"requests", "tiles read"},
          {"bytes", "MB"},
          {"rate", "tiles a second", 0},
          {"kept", "% of the cold requests", 0},
          {"tiles", "of the view"},
          {"there", "% of them", 0},
          {"rms", "8-bit levels"}};
}

Report measure_stream(const BenchOptions& options, TestPlanet planet) {
  Report report{.name = "stream",
                .title = "From nothing to a settled view: time, requests and bytes beside the error on the screen",
                .facts = {{"renderer", renderer_name()},
                          {"time", "wall time, drawing included"},
                          {"tiles", "a folder of PNG tiles on disk, decoded by two threads; nothing kept at first"}},
                .columns = stream_columns()};
  report.facts.emplace_back(
      "picture", fmt::format("noise planet, {}x{}", planet.source.picture.width, planet.source.picture.height));
  Streamer streamer(options, std::move(planet));
  for (const StreamView& view : stream_views(options.effort)) {
    if (options.wants(view.name)) streamer.measure(view, report);
  }
  report.plots = {{.title = "error on the screen, from an empty cache",
                   .x = "time",
                   .y = "rms",
                   .series = "view",
                   .only = {{"visit", {"cold"}}}},
                  {.title = "requests, from an empty cache",
                   .x = "time",
                   .y = "requests",
                   .series = "view",
                   .only = {{"visit", {"cold"}}}}};
  return report;
}

}  // namespace

Result<Report> bench_stream(const BenchOptions& options) {
  auto planet = noise_test_folder(options);
  if (!planet) return planet.error();
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  try {
    return measure_stream(options, *std::move(planet));
  } catch (const std::exception& error) {
    return Error{error.what()};
  }
}

}  // namespace terrella::bench
