#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "apps/bench/accuracy_settings.h"
#include "apps/bench/frame_timing.h"
#include "apps/bench/mesh_error.h"
#include "apps/bench/shots.h"
#include "apps/bench/sources/counting_source.h"
#include "apps/bench/test_planet.h"
#include "apps/bench/truth/masked_error.h"
#include "geo/body.h"
#include "globe/experiments.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella::bench {
namespace {

using truth::ZoneError;

/// Figures of one setting in one view.
struct AccuracyFigures {
  double selection_ms = 0.0, frame_ms = 0.0, frame_cpu_ms = 0.0;
  std::int64_t patches = 0, triangles = 0;
  MeshError mesh;
  std::int64_t tiles = 0;
  double tile_mb = 0.0, gpu_mb = 0.0;
  double rms = kNoFigure, rms_pole = kNoFigure, rms_elsewhere = kNoFigure, rms_borders = kNoFigure;
};

/// GPU memory of tiles, including gutters and mips.
double slots_mb(const TileGrid& grid, int gutter_px, std::int64_t tiles) {
  constexpr double kMipsOverFinest = 1.0 + 1.0 / 4 + 1.0 / 16 + 1.0 / 64, kBytesATexel = 4.0;
  const double side = grid.tile_px + 2.0 * gutter_px;
  return 1e-6 * kBytesATexel * kMipsOverFinest * side * side * static_cast<double>(tiles);
}

/// Intersects a mask with another, or subtracts the other.
truth::Mask within(truth::Mask mask, const truth::Mask& other, bool inside = true) {
  for (std::size_t k = 0; k < mask.set.size(); ++k) mask.set[k] = mask.set[k] != 0 && (other.set[k] != 0) == inside;
  return mask;
}

double rms_of(const ZoneError& zone) { return zone.pixels == 0 ? kNoFigure : zone.rms; }

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
    for (const AccuracySetting& setting : accuracy_settings(options_.effort)) {
      AccuracyFigures figures;
      select(setting, view.camera, figures);
      draw(setting, view, truth, figures);
      add_row(report, view, setting, figures);
    }
  }

 private:
  static TileGrid grid_of(const std::filesystem::path& tiles) {
    const auto source = open_tile_set(tiles);
    if (!source) throw std::runtime_error(source.error().message);
    return source.value()->info().grid;
  }

  void select(const AccuracySetting& setting, const truth::TruthCamera& camera, AccuracyFigures& figures) const {
    TileGrid grid = grid_;
    grid.reduced = grid.reduced && setting.globe.squeezed_rows;
    PatchTree tree(earth().ellipsoid, grid, setting.globe.segments, setting.mapping);
    const Camera eye = as_globe_camera(camera);
    const View view = make_view(eye, earth().ellipsoid, viewport_);
    std::vector<SelectedPatch> patches;
    std::vector<double> times_ms;
    for (int round = -1; round < rounds_; ++round) {  // the first round builds the tree
      const auto start = std::chrono::steady_clock::now();
      select_patches(tree, view, selection_of(setting.globe), patches);
      const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
      if (round >= 0) times_ms.push_back(took.count());
    }
    figures.selection_ms = median(times_ms);
    figures.patches = static_cast<std::int64_t>(patches.size());
    figures.triangles = mesh_count(tree, view, patches).triangles;
    figures.mesh = mesh_error(tree, view, eye, patches, true);
  }

  /// Draws with a new globe, so that the requests are those of this view.
  void draw(const AccuracySetting& setting, const AccuracyView& view, const truth::TruthImage& truth,
            AccuracyFigures& figures) {
    auto opened = open_tile_set(planet_.tiles);
    if (!opened) throw std::runtime_error(opened.error().message);
    const auto source = std::make_shared<CountingSource>(*std::move(opened));
    const auto globe = Globe::create(setting.globe);
    if (!globe) throw std::runtime_error(globe.error().message);
    Experiments::of(**globe).mapping = setting.mapping;
    if (const auto added = (*globe)->add_imagery(source); !added) throw std::runtime_error(added.error().message);
    const FrameStats stats = settle(**globe, view.camera, target_, viewport_);
    judge(shot(target_, viewport_), view, truth, figures);
    figures.tiles = stats.tiles_wanted;
    figures.tile_mb = 1e-6 * static_cast<double>(source->bytes());
    figures.gpu_mb = slots_mb(grid_, setting.globe.gutter_px, figures.tiles);
    std::vector<Subject> subjects{{"frame", [&] { (*globe)->render(target_.framebuffer(), viewport_); }}};
    time_frames(subjects, rounds_);
    figures.frame_ms = median(subjects.front().ms);
    figures.frame_cpu_ms = median(subjects.front().cpu_ms);
  }

  void judge(const truth::Picture& shown, const AccuracyView& view, const truth::TruthImage& truth,
             AccuracyFigures& figures) const {
    const truth::Mask clear = truth::clear_mask(truth), pole = truth::pole_band_mask(truth);
    figures.rms = rms_of(truth::masked_error(shown, truth, clear));
    figures.rms_pole = rms_of(truth::masked_error(shown, truth, pole));
    figures.rms_elsewhere = rms_of(truth::masked_error(shown, truth, within(clear, pole, false)));
    if (!view.magnified) return;  // in other views, the borders between tiles depend on the view
    const truth::Mask borders = truth::tile_border_mask(
        truth, as_spheroid(earth().ellipsoid), {}, {.root_span_deg = grid_.root_span_deg, .level = grid_.max_level});
    figures.rms_borders = rms_of(truth::masked_error(shown, truth, within(borders, clear)));
  }

  static void add_row(Report& report, const AccuracyView& view, const AccuracySetting& setting,
                      const AccuracyFigures& f) {
    report.rows.push_back({std::string(setting.sweep), setting.value, view.name, f.frame_ms, f.frame_cpu_ms,
                           f.selection_ms, f.patches, f.triangles, f.mesh.position_px, f.mesh.position_rms_px,
                           f.mesh.texture_texels, f.mesh.silhouette_px, f.tiles, f.tile_mb, f.gpu_mb, f.rms, f.rms_pole,
                           f.rms_elsewhere, f.rms_borders});
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
          {"time", "ms a frame"},
          {"cpu_time", "ms a frame"},
          {"selection", "ms a frame", 3},
          {"patches", ""},
          {"triangles", ""},
          {"position_error", "px, greatest", 4},
          {"position_rms", "px", 4},
          {"texture_error", "texels, greatest", 4},
          {"silhouette_error", "px, greatest", 4},
          {"tiles", ""},
          {"tile_bytes", "MB read"},
          {"gpu_bytes", "MB of the tiles"},
          {"rms", "8-bit levels"},
          {"rms_pole", "8-bit levels"},
          {"rms_elsewhere", "8-bit levels"},
          {"rms_borders", "beside tile borders"}};
}

double of_default(const Report& report, const std::string& view, const char* column) {
  for (const std::vector<Cell>& row : report.rows) {
    if (std::get<std::string>(row[0]) != kDefaults || std::get<std::string>(row[report.column("view")]) != view)
      continue;
    const Cell& cell = row[report.column(column)];
    const auto* whole = std::get_if<std::int64_t>(&cell);
    return whole != nullptr ? static_cast<double>(*whole) : std::get<double>(cell);
  }
  return kNoFigure;
}

/// Adds ratios of views over a pole to views over the equator at the same height. A single height shows only where
/// levels change; means over an octave of heights are meaningful.
void add_polar_findings(const std::vector<AccuracyView>& views, Report& report) {
  constexpr double kMoreTiles = 1.5, kMoreError = 1.1;
  for (const auto& [column, limit] : {std::pair{"tiles", kMoreTiles}, {"rms", kMoreError}}) {
    double logs = 0.0;
    int pairs = 0;
    for (const AccuracyView& view : views) {
      if (view.twin.empty() || std::ranges::find(views, view.twin, &AccuracyView::name) == views.end()) continue;
      const double ratio = of_default(report, view.name, column) / of_default(report, view.twin, column);
      report.findings.push_back({fmt::format("{}: {} over those at the equator", view.name, column), ratio});
      logs += std::log(ratio);
      ++pairs;
    }
    if (pairs == 0) continue;
    report.findings.push_back({fmt::format("{} over a pole over those at the equator, mean of heights", column),
                               std::exp(logs / pairs), limit});
  }
}

void add_findings(const std::vector<AccuracyView>& views, Report& report) {
  constexpr double kPosition_px = 0.25;
  for (const char* column : {"position_error", "silhouette_error"}) {
    double most = 0.0;
    for (const AccuracyView& view : views) most = std::max(most, of_default(report, view.name, column));
    report.findings.push_back({fmt::format("greatest {} with the defaults", column), most, kPosition_px, "px"});
  }
  add_polar_findings(views, report);
}

std::vector<Plot> accuracy_plots(const std::vector<AccuracyView>& views) {
  const std::string pole = "beside the pole, 6000 km", middle = "mid latitude, 6000 km";
  std::vector<std::string> pairs;  // views and their twins; the finest tiles do not limit them
  for (const AccuracyView& view : views) {
    if (!view.twin.empty()) pairs.insert(pairs.end(), {view.twin, view.name});
  }
  if (pairs.empty()) pairs = {pole, middle};
  const Plot log{.title = {}, .x = "tiles", .y = "rms", .series = "view", .log_x = true, .log_y = true};
  Plot detail = log, tiles = log, columns = log, triangles = log;
  detail.title = "detail: texels per pixel";
  detail.x = "value";
  detail.only = tiles.only = {{"sweep", {kDetail}}, {"view", pairs}};
  tiles.title = "tiles that they take";
  columns.title = "tiles for accuracy beside the pole, 6000 km";
  columns.y = "rms_pole";
  columns.series = triangles.series = "sweep";
  columns.only = {{"sweep", {kDefaults, kDetail, kColumns}}, {"view", {pole}}};
  triangles.title = "triangles for accuracy, " + middle;
  triangles.x = "triangles";
  triangles.y = "position_error";
  triangles.only = {{"sweep", {kDefaults, kTessellation, kThreshold, kPlainThreshold}}, {"view", {middle}}};
  return {detail, tiles, columns, triangles};
}

Report measure_accuracy(const BenchOptions& options, TestPlanet planet) {
  Report report{.name = "accuracy",
                .title =
                    "What accuracy costs: tessellation, screen-error threshold, cube mapping, detail, tile columns "
                    "at a pole, gutters",
                .facts = {{"renderer", renderer_name()}, {"time", timing_method()}},
                .columns = accuracy_columns()};
  report.facts.emplace_back(
      "picture", fmt::format("noise planet, {}x{}", planet.source.picture.width, planet.source.picture.height));
  report.facts.emplace_back("polar columns",
                            "on the full grid, as tile sets of others have it; all else takes squeezed rows");
  AccuracyLab lab(options, std::move(planet));
  std::vector<AccuracyView> views = accuracy_views(options.effort);
  std::erase_if(views, [&](const AccuracyView& view) { return !options.wants(view.name); });
  for (const AccuracyView& view : views) lab.measure(view, report);
  report.plots = accuracy_plots(views);
  add_findings(views, report);
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
