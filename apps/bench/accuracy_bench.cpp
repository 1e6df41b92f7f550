#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "apps/bench/benches.h"
#include "apps/bench/counting_source.h"
#include "apps/bench/frame_timing.h"
#include "apps/bench/mesh_error.h"
#include "apps/bench/shots.h"
#include "apps/bench/truth/masked_error.h"
#include "apps/bench/work_folder.h"
#include "geo/body.h"

namespace terrella::bench {
namespace {

using truth::ZoneError;

/// One value of one parameter, the others at their defaults.
struct Setting {
  const char* sweep;
  double value;
  int segments = 24;
  PatchSelectionOptions selection = {};
  std::optional<GlobeOptions> globe = {};  ///< what is drawn as well; none: the mesh alone is looked at
};

struct AccuracyView {
  const char* name;
  truth::TruthCamera camera;
};

std::vector<AccuracyView> views_of(Effort effort) {
  std::vector<AccuracyView> views = {{"mid latitude, 6000 km", {.eye = {30, 20, 6e6}}},
                                     {"beside the pole, 6000 km", {.eye = {89.9, 0, 6e6}}}};
  if (effort == Effort::quick) return views;
  views.push_back({"beside the pole, 1500 km", {.eye = {88, 10, 1.5e6}}});
  views.push_back({"low oblique, 300 km", {{46, 7, 3e5}, 30, -20, 45}});
  if (effort == Effort::full) {
    views.push_back({"four radii", {.eye = {20, 10, 3 * 6378137.0}}});
    views.push_back({"pole, tilted 45°", {{80, 180, 1.2e6}, 0, -45, 40}});
  }
  return views;
}

/// As the globe is by default; on the full grid, as the tile sets of others are, with this many columns at a pole.
GlobeOptions drawn(std::optional<int> full_grid_columns) {
  GlobeOptions options;
  options.unlit = true;
  options.upload_bytes_per_frame = options.gpu_bytes;
  options.upload_time_per_frame = std::chrono::seconds(1);
  options.squeezed_rows = !full_grid_columns;
  if (full_grid_columns) options.polar_columns = *full_grid_columns;
  return options;
}

std::vector<Setting> settings_of(Effort effort) {
  std::vector<Setting> settings{{"default", kNoFigure}};
  settings.back().globe = drawn(std::nullopt);
  const bool quick = effort == Effort::quick;
  for (const int n : quick ? std::vector{4, 24} : std::vector{4, 8, 16, 24, 32, 48, 64, 96, 128}) {
    settings.push_back({"tessellation", static_cast<double>(n), n});
  }
  for (const double px : quick ? std::vector{0.2, 1.0} : std::vector{0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2}) {
    settings.push_back({"threshold", px});
    settings.back().selection.max_error_px = px;
  }
  for (const int columns : quick ? std::vector{32} : std::vector{8, 16, 32, 64, 128}) {
    settings.push_back({"polar columns", static_cast<double>(columns)});
    settings.back().selection.max_polar_columns = columns;
    settings.back().globe = drawn(columns);
  }
  return settings;
}

/// What was found of one setting in one view; NaN: it was not drawn.
struct AccuracyFigures {
  double ms = kNoFigure;
  std::int64_t patches = 0, triangles = 0;
  MeshError mesh;
  double tiles = kNoFigure, tile_mb = kNoFigure, rms = kNoFigure, rms_pole = kNoFigure;
};

class AccuracyLab {
 public:
  AccuracyLab(const BenchOptions& options, TestPlanet planet)
      : options_(options),
        side_px_(options.effort == Effort::quick ? 192 : 1024),
        rays_(options.effort == Effort::quick ? 4 : 8),
        rounds_(options.effort == Effort::quick    ? 2
                : options.effort == Effort::normal ? 7
                                                   : 15),
        viewport_{side_px_, side_px_},
        planet_(std::move(planet)),
        target_(viewport_),
        grid_(grid_of(planet_.tiles)) {}

  void measure(const AccuracyView& view, Report& report) {
    options_.progress(fmt::format("{}: ground truth", view.name));
    const truth::TruthImage truth =
        truth::cast_cached(planet_.source, {}, as_spheroid(earth().ellipsoid), view.camera,
                           {.width = side_px_, .height = side_px_, .rays_per_side = rays_}, truth_folder(options_));
    options_.progress(fmt::format("{}: drawing", view.name));
    for (const Setting& setting : settings_of(options_.effort)) {
      AccuracyFigures figures = select(setting, view.camera);
      if (setting.globe) draw(*setting.globe, view.camera, truth, figures);
      add_row(report, view, setting, figures);
    }
  }

 private:
  static TileGrid grid_of(const std::filesystem::path& tiles) {
    const auto source = open_tile_set(tiles);
    if (!source) throw std::runtime_error(source.error().message);
    return source.value()->info().grid;
  }

  AccuracyFigures select(const Setting& setting, const truth::TruthCamera& camera) const {
    PatchTree tree(earth().ellipsoid, grid_, setting.segments);
    const Camera eye = as_globe_camera(camera);
    const View view = make_view(eye, earth().ellipsoid, viewport_);
    std::vector<SelectedPatch> patches;
    std::vector<double> times_ms;
    for (int round = -1; round < rounds_; ++round) {  // the first makes the tree
      const auto start = std::chrono::steady_clock::now();
      select_patches(tree, view, setting.selection, patches);
      const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
      if (round >= 0) times_ms.push_back(took.count());
    }
    AccuracyFigures figures;
    figures.ms = median(times_ms);
    figures.patches = static_cast<std::int64_t>(patches.size());
    figures.triangles = mesh_count(tree, view, patches).triangles;
    figures.mesh = mesh_error(tree, view, eye, patches, true);
    return figures;
  }

  /// A globe made anew, so that what it reads is what this view takes.
  void draw(const GlobeOptions& options, const truth::TruthCamera& camera, const truth::TruthImage& truth,
            AccuracyFigures& figures) {
    auto opened = open_tile_set(planet_.tiles);
    if (!opened) throw std::runtime_error(opened.error().message);
    const auto source = std::make_shared<CountingSource>(*std::move(opened));
    const auto globe = Globe::create(options, source);
    if (!globe) throw std::runtime_error(globe.error().message);
    const FrameStats stats = settle(**globe, camera, target_, viewport_);
    const truth::Picture shown = shot(target_, viewport_);
    const ZoneError pole = truth::masked_error(shown, truth, truth::pole_band_mask(truth));
    figures.rms = truth::masked_error(shown, truth, truth::clear_mask(truth)).rms;
    figures.rms_pole = pole.pixels == 0 ? kNoFigure : pole.rms;
    figures.tiles = stats.tiles_wanted;
    figures.tile_mb = 1e-6 * static_cast<double>(source->bytes());
    std::vector<Subject> subjects{{"frame", [&] { (*globe)->render(target_.framebuffer(), viewport_); }}};
    time_frames(subjects, rounds_);
    figures.ms = median(subjects.front().ms);
  }

  static void add_row(Report& report, const AccuracyView& view, const Setting& setting, const AccuracyFigures& f) {
    report.rows.push_back({std::string(setting.sweep), setting.value, std::string(view.name), f.ms, f.patches,
                           f.triangles, f.mesh.position_px, f.mesh.position_rms_px, f.mesh.texture_texels,
                           f.mesh.silhouette_px, f.tiles, f.tile_mb, f.rms, f.rms_pole});
  }

  const BenchOptions& options_;
  int side_px_, rays_, rounds_;
  Viewport viewport_;
  TestPlanet planet_;
  OffscreenTarget target_;
  TileGrid grid_;
};

std::vector<Column> accuracy_columns() {
  return {{"sweep", ""},
          {"value", ""},
          {"view", ""},
          {"time", "ms", 3},
          {"patches", ""},
          {"triangles", ""},
          {"position_error", "px, greatest", 4},
          {"position_rms", "px", 4},
          {"texture_error", "texels, greatest", 4},
          {"silhouette_error", "px, greatest", 4},
          {"tiles", "", 0},
          {"tile_bytes", "MB"},
          {"rms", "8-bit levels"},
          {"rms_pole", "8-bit levels"}};
}

Plot curve(const char* sweep, const char* title, const char* x, const char* y) {
  return {.title = title,
          .x = x,
          .y = y,
          .series = "view",
          .log_x = true,
          .log_y = true,
          .only_column = "sweep",
          .only_value = sweep};
}

double greatest_of(const Report& report, const char* sweep, const char* column) {
  double most = 0.0;
  for (const std::vector<Cell>& row : report.rows) {
    if (std::get<std::string>(row[0]) == sweep) most = std::max(most, std::get<double>(row[report.column(column)]));
  }
  return most;
}

Report measure_accuracy(const BenchOptions& options, TestPlanet planet) {
  Report report{
      .name = "accuracy",
      .title = "What accuracy costs: tessellation, screen-error threshold, tile columns at a pole",
      .facts = {{"renderer", renderer_name()},
                {"time", "of a frame: " + timing_method() + "; of tessellation and threshold: of the selection"}},
      .columns = accuracy_columns()};
  report.facts.emplace_back(
      "picture", fmt::format("noise planet, {}x{}", planet.source.picture.width, planet.source.picture.height));
  report.facts.emplace_back("polar columns",
                            "on the full grid, as tile sets of others have it; the default takes squeezed rows");
  AccuracyLab lab(options, std::move(planet));
  for (const AccuracyView& view : views_of(options.effort)) {
    if (options.wants(view.name)) lab.measure(view, report);
  }
  report.plots = {curve("threshold", "threshold: triangles for accuracy", "triangles", "position_error"),
                  curve("tessellation", "tessellation: triangles for accuracy", "triangles", "position_error"),
                  curve("polar columns", "full grid: tiles for accuracy in the pole band", "tiles", "rms_pole")};
  constexpr double kPosition_px = 0.25;
  report.findings = {{"greatest position error with the defaults", greatest_of(report, "default", "position_error"),
                      kPosition_px, "px"},
                     {"greatest silhouette error with the defaults", greatest_of(report, "default", "silhouette_error"),
                      kPosition_px, "px"}};
  return report;
}

}  // namespace

Result<Report> bench_accuracy(const BenchOptions& options) {
  auto planet = noise_test_planet(options);
  if (!planet) return planet.error();
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  try {
    return measure_accuracy(options, *std::move(planet));
  } catch (const std::exception& error) {
    return Error{error.what()};
  }
}

}  // namespace terrella::bench
