#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <utility>

#include "apps/bench/benches.h"
#include "apps/bench/frame_timing.h"
#include "apps/bench/polar_methods.h"
#include "apps/bench/polar_views.h"
#include "apps/bench/shots.h"
#include "apps/bench/test_planet.h"
#include "apps/bench/truth/judge.h"
#include "geo/body.h"

namespace terrella::bench {
namespace {

using truth::Zone;

struct ViewsSize {
  int side_px;
  int rays_per_side;
  int rounds;
};
ViewsSize views_size(Effort effort) {
  if (effort == Effort::quick) return {192, 4, 2};
  return {1024, 8, effort == Effort::full ? 15 : 9};
}

/// A view, and the zone of it whose error counts. `limit`: the RMS that was reached before, and 0.01 more.
struct TableView {
  std::string name;
  std::string body;
  truth::TruthCamera camera;
  Zone zone;
  double limit = kNoFigure;
};

std::vector<TableView> table_views(Effort effort) {
  const double inscribed_m = inscribed_height_m();
  const TableView side{"inscribed, side", "sphere", {.eye = {0, 20, inscribed_m}}, Zone::mid_latitudes};
  const TableView pole{"inscribed, pole", "sphere", {.eye = {90, 0, inscribed_m}}, Zone::pole};
  const TableView beside{"beside the pole, 1500 km", "earth", {.eye = {88, 10, 1.5e6}}, Zone::pole, 0.30};
  if (effort == Effort::quick) return {beside, side};
  return {{"mid latitude, 6000 km", "earth", {.eye = {30, 20, 6e6}}, Zone::all, 0.46},
          {"antimeridian, 6000 km", "earth", {.eye = {0, 180, 6e6}}, Zone::antimeridian, 0.40},
          {"beside the pole, 6000 km", "earth", {.eye = {89.9, 0, 6e6}}, Zone::pole, 0.38},
          beside,
          {"pole, tilted 45°", "earth", {{80, 180, 1.2e6}, 0, -45, 40}, Zone::pole_clear, 0.34},
          {"low oblique, 300 km", "earth", {{46, 7, 3e5}, 30, -20, 45}, Zone::clear, 0.33},
          side,
          pole};
}

constexpr std::array kTexturings{std::pair{"vertex", Texturing::vertex}, std::pair{"paper", Texturing::paper},
                                 std::pair{"exact", Texturing::exact}, std::pair{"auto", Texturing::automatic}};

class ViewsLab {
 public:
  ViewsLab(const BenchOptions& options, TestPlanet planet)
      : options_(options),
        size_(views_size(options.effort)),
        viewport_{size_.side_px, size_.side_px},
        planet_(std::move(planet)),
        sphere_(planet_.source.picture, 48, size_.side_px),
        target_(viewport_) {}

  void measure(const TableView& view, Report& report) {
    const Body body = *parse_body(view.body);
    options_.progress(view.name + ": ground truth");
    const truth::TruthImage truth =
        truth::cast_cached(planet_.source, {}, as_spheroid(body.ellipsoid), view.camera,
                           {.width = size_.side_px, .height = size_.side_px, .rays_per_side = size_.rays_per_side},
                           truth_folder(options_));
    options_.progress(view.name + ": drawing");
    std::vector<std::unique_ptr<Globe>> globes;
    std::vector<Subject> subjects{{kPlainSphere, [&] { sphere_.draw(view.camera, body.ellipsoid.a_m()); }}};
    std::vector<Cell> row{view.name, std::string(zone_name(view.zone))};
    std::int64_t tiles = 0;
    for (const auto& [name, texturing] : kTexturings) {
      globes.push_back(open_globe(planet_.tiles.string(), {.body = body, .texturing = texturing, .unlit = true}));
      tiles = settle(*globes.back(), view.camera, target_, viewport_).tiles_wanted;
      const truth::Judgement judged =
          truth::judge(shot(target_, viewport_), truth, as_spheroid(body.ellipsoid), {}, std::nullopt);
      row.emplace_back(judged[view.zone].rms);
      subjects.push_back(
          {name, [this, globe = globes.back().get()] { globe->render(target_.framebuffer(), viewport_); }});
    }
    time_frames(subjects, size_.rounds);
    add_times(subjects, row);
    row.emplace_back(tiles);
    report.rows.push_back(std::move(row));
  }

 private:
  /// The plain sphere's time, `vertex` over it, and the other texturings over `vertex`; by wall and processor time.
  static void add_times(const std::vector<Subject>& subjects, std::vector<Cell>& row) {
    row.emplace_back(median(subjects[0].ms));
    row.emplace_back(median(subjects[0].cpu_ms));
    for (std::size_t k = 1; k < subjects.size(); ++k) {
      const Subject& base = subjects[k == 1 ? 0 : 1];
      row.emplace_back(median_ratio(subjects[k].ms, base.ms));
      row.emplace_back(median_ratio(subjects[k].cpu_ms, base.cpu_ms));
    }
  }

  const BenchOptions& options_;
  ViewsSize size_;
  Viewport viewport_;
  TestPlanet planet_;
  PaperSphere sphere_;
  OffscreenTarget target_;
};

std::vector<Column> views_columns() {
  std::vector<Column> columns{{"view", ""}, {"zone", ""}};
  for (const auto& [name, texturing] : kTexturings) columns.push_back({fmt::format("rms_{}", name), "8-bit levels"});
  columns.push_back({"plain_time", "ms", 1});
  columns.push_back({"plain_cpu_time", "ms", 1});
  for (const auto& [name, texturing] : kTexturings) {
    const char* base = texturing == Texturing::vertex ? "plain" : "vertex";
    columns.push_back({fmt::format("{}_over_{}", name, base), "time"});
    columns.push_back({fmt::format("{}_over_{}_cpu", name, base), "processor time"});
  }
  columns.push_back({"tiles", ""});
  return columns;
}

Report measure_views(const BenchOptions& options, TestPlanet planet) {
  constexpr double kMostOverVertex = 1.25;
  Report report{.name = "views",
                .title = "The globe beside Zuev's plain sphere (2023), time beside error: the table of the README",
                .facts = {{"renderer", renderer_name()}, {"time", timing_method()}},
                .columns = views_columns()};
  report.facts.emplace_back(
      "picture", fmt::format("noise planet, {}x{}", planet.source.picture.width, planet.source.picture.height));
  ViewsLab lab(options, std::move(planet));
  for (const TableView& view : table_views(options.effort)) {
    if (!options.wants(view.name)) continue;
    lab.measure(view, report);
    const auto figure = [&](const char* column) { return std::get<double>(report.rows.back()[report.column(column)]); };
    const bool quick = options.effort == Effort::quick;  // its pictures are too small for these limits
    report.findings.push_back(
        {view.name + ": RMS of auto", figure("rms_auto"), quick ? kNoFigure : view.limit, "levels"});
    report.findings.push_back({view.name + ": processor time of auto over vertex", figure("auto_over_vertex_cpu"),
                               quick ? kNoFigure : kMostOverVertex});
  }
  report.plots = {{.title = "error of auto beside its time over vertex",
                   .x = "auto_over_vertex",
                   .y = "rms_auto",
                   .series = "view",
                   .lines = false}};
  return report;
}

}  // namespace

Result<Report> bench_views(const BenchOptions& options) {
  auto planet = noise_test_planet(options);
  if (!planet) return planet.error();
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  try {
    return measure_views(options, *std::move(planet));
  } catch (const std::exception& error) {
    return Error{error.what()};
  }
}

}  // namespace terrella::bench
