#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "apps/bench/benches.h"
#include "apps/bench/frame_timing.h"
#include "apps/bench/mesh_error.h"
#include "apps/bench/shots.h"
#include "apps/bench/sources/counting_source.h"
#include "apps/bench/sources/endless_source.h"
#include "apps/flight/flight_file.h"
#include "apps/process/data_dir.h"
#include "geo/body.h"

namespace terrella::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array kFlights{"orbit_to_street", "pole_crossing", "antimeridian_crossing", "horizon_skim"};

struct FlightEffort {
  int side_px;
  int frames;
  int looks;  ///< frames of each flight that are compared with the settled view
};
FlightEffort effort_of(Effort effort) {
  if (effort == Effort::quick) return {96, 8, 1};
  return effort == Effort::full ? FlightEffort{1024, 1200, 24} : FlightEffort{1024, 240, 8};
}

/// Spreads cameras evenly between the positions of each flight.
std::vector<Camera> cameras_of(const std::vector<FlightPath>& paths, int frames) {
  std::size_t parts = 0;
  for (const FlightPath& path : paths) parts += path.times().size() - 1;
  const int frames_of_part = std::max(1, frames / static_cast<int>(std::max<std::size_t>(parts, 1)));
  std::vector<Camera> cameras;
  for (const FlightPath& path : paths) {
    const std::vector<double>& times = path.times();
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
      const Camera from = path.at(times[i]).camera, to = path.at(times[i + 1]).camera;
      for (int k = 0; k < frames_of_part; ++k) {
        cameras.push_back(camera_between(from, to, static_cast<double>(k) / frames_of_part));
      }
    }
    cameras.push_back(path.at(path.duration_s()).camera);
  }
  return cameras;
}

/// Figures of all frames of a flight, in order.
struct FlightFigures {
  std::vector<double> frame_ms, selection_ms, patches, draws, triangles, uploads_mb, tiles;
  std::vector<double> missing_share, lag_rms;  ///< lag: only of the compared frames
  MeshCount mesh;
  double worst_position_px = 0.0;
  int uncovered_frames = 0;
};

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}
double greatest(const std::vector<double>& values) { return values.empty() ? 0.0 : *std::ranges::max_element(values); }
double sum(const std::vector<double>& values) { return mean(values) * static_cast<double>(values.size()); }

double rms_between(const truth::Picture& a, const truth::Picture& b) {
  double squares = 0.0;
  for (std::size_t k = 0; k < a.rgb.size(); ++k) {
    const double off = static_cast<double>(a.rgb[k]) - static_cast<double>(b.rgb[k]);
    squares += off * off;
  }
  return std::sqrt(squares / static_cast<double>(a.rgb.size()));
}

class Flyer {
 public:
  explicit Flyer(const BenchOptions& options)
      : options_(options),
        effort_(effort_of(options.effort)),
        viewport_{effort_.side_px, effort_.side_px},
        target_(viewport_) {}

  void fly(const std::string& name, Report& report) {
    options_.progress(name);
    const auto flight = read_flight(data_file("flights/" + name + ".geojson"));
    if (!flight) throw std::runtime_error(flight.error().message);
    const std::vector<Camera> cameras = cameras_of(flight->paths, effort_.frames);
    auto source = std::make_shared<CountingSource>(make_endless_source());
    const std::unique_ptr<Globe> globe = open(source, false);
    const std::unique_ptr<Globe> patient = open(std::make_shared<CountingSource>(make_endless_source()), true);
    tree_ = std::make_unique<PatchTree>(earth().ellipsoid, source->info().grid, GlobeOptions{}.segments);
    FlightFigures figures;
    const auto every = std::max<std::size_t>(1, cameras.size() / static_cast<std::size_t>(effort_.looks));
    for (std::size_t k = 0; k < cameras.size(); ++k) {
      frame(*globe, cameras[k], figures);
      if (k % every == every - 1) look(*patient, cameras[k], figures);
    }
    add_row(report, name, figures, *source);
  }

 private:
  [[nodiscard]] static std::unique_ptr<Globe> open(std::shared_ptr<TileSource> source, bool at_once) {
    GlobeOptions options;
    options.unlit = true;
    if (at_once) {
      options.upload_bytes_per_frame = options.gpu_bytes;
      options.upload_time_per_frame = std::chrono::seconds(1);
    }
    auto globe = Globe::create(options, std::move(source));
    if (!globe) throw std::runtime_error(globe.error().message);
    return *std::move(globe);
  }

  void frame(Globe& globe, const Camera& camera, FlightFigures& figures) {
    globe.set_camera(camera);
    FrameStats stats;
    const FrameTime time = time_frame([&] { stats = globe.render(target_.framebuffer(), viewport_); });
    figures.frame_ms.push_back(time.ms);
    figures.selection_ms.push_back(stats.selection_ms);
    figures.patches.push_back(stats.patches);
    figures.draws.push_back(stats.draw_calls);
    figures.triangles.push_back(static_cast<double>(stats.triangles));
    figures.uploads_mb.push_back(1e-6 * static_cast<double>(stats.uploaded_bytes));
    figures.tiles.push_back(stats.tiles_wanted);
    figures.missing_share.push_back(stats.tiles_wanted == 0 ? 0.0
                                                            : static_cast<double>(stats.tiles_pending) /
                                                                  static_cast<double>(stats.tiles_wanted));
    figures.uncovered_frames += stats.patches_uncovered > 0 ? 1 : 0;
  }

  /// Compares the screen with the settled view, and counts needless patches and triangles.
  void look(Globe& patient, const Camera& camera, FlightFigures& figures) {
    const truth::Picture shown = shot(target_, viewport_);
    settle(patient, as_truth_camera(camera), target_, viewport_);
    figures.lag_rms.push_back(rms_between(shown, shot(target_, viewport_)));
    const View view = make_view(camera, earth().ellipsoid, viewport_);
    std::vector<SelectedPatch> patches;
    select_patches(*tree_, view, {}, patches);
    const MeshCount count = mesh_count(*tree_, view, patches);
    figures.mesh.patches += count.patches;
    figures.mesh.triangles += count.triangles;
    figures.mesh.needless_patches += count.needless_patches;
    figures.mesh.needless_triangles += count.needless_triangles;
    const MeshError error = mesh_error(*tree_, view, camera, patches, true);
    figures.worst_position_px = std::max(figures.worst_position_px, error.position_px);
  }

  static void add_row(Report& report, const std::string& name, const FlightFigures& f, const CountingSource& source) {
    const auto percent = [](std::int64_t part, std::int64_t whole) {
      return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
    };
    report.rows.push_back({name,
                           static_cast<std::int64_t>(f.frame_ms.size()),
                           median(f.frame_ms),
                           greatest(f.frame_ms),
                           median(f.selection_ms),
                           greatest(f.selection_ms),
                           mean(f.patches),
                           greatest(f.patches),
                           mean(f.draws),
                           mean(f.triangles),
                           sum(f.uploads_mb),
                           greatest(f.uploads_mb),
                           source.requests(),
                           greatest(f.tiles),
                           percent(f.mesh.needless_patches, f.mesh.patches),
                           percent(f.mesh.needless_triangles, f.mesh.triangles),
                           100.0 * mean(f.missing_share),
                           std::int64_t{f.uncovered_frames},
                           f.worst_position_px,
                           mean(f.lag_rms),
                           greatest(f.lag_rms)});
  }

  const BenchOptions& options_;
  FlightEffort effort_;
  Viewport viewport_;
  OffscreenTarget target_;
  std::unique_ptr<PatchTree> tree_;
};

std::vector<Column> traverse_columns() {
  return {{"flight", ""},
          {"frames", ""},
          {"time", "ms, median"},
          {"time_max", "ms"},
          {"selection", "ms, median", 3},
          {"selection_max", "ms", 3},
          {"patches", "mean", 0},
          {"patches_max", "", 0},
          {"draws", "mean", 1},
          {"triangles", "mean", 0},
          {"uploads", "MB"},
          {"uploads_max", "MB a frame"},
          {"requests", "tiles"},
          {"tiles_max", "a frame", 0},
          {"needless_patches", "%", 1},
          {"needless_triangles", "%", 1},
          {"missing", "% of tiles", 1},
          {"uncovered", "frames"},
          {"position_error", "px, greatest", 3},
          {"rms_lag", "8-bit levels"},
          {"rms_lag_max", "8-bit levels"}};
}

Report measure_traverse(const BenchOptions& options) {
  Report report{.name = "traverse",
                .title = "Flights: what selection, drawing and uploads cost on the way, and how far the picture lags",
                .facts = {{"renderer", renderer_name()},
                          {"time", timing_method()},
                          {"imagery", "waves, levels 0 to 18, made on request"}},
                .columns = traverse_columns()};
  Flyer flyer(options);
  for (const char* flight : kFlights) {
    if (options.wants(flight)) flyer.fly(flight, report);
  }
  report.plots = {
      {.title = "what is drawn and not needed",
       .x = "triangles",
       .y = "needless_triangles",
       .series = "flight",
       .lines = false},
      {.title = "lag behind the settled picture", .x = "time", .y = "rms_lag", .series = "flight", .lines = false}};
  return report;
}

}  // namespace

Result<Report> bench_traverse(const BenchOptions& options) {
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  try {
    return measure_traverse(options);
  } catch (const BrokenInstallation&) {
    throw;
  } catch (const std::exception& error) {
    return Error{error.what()};
  }
}

}  // namespace terrella::bench
