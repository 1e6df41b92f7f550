#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "apps/bench/benches.h"
#include "apps/bench/frame_timing.h"
#include "apps/bench/polar_methods.h"
#include "apps/bench/polar_views.h"
#include "apps/bench/shots.h"
#include "apps/bench/test_planet.h"
#include "apps/bench/truth/masked_error.h"
#include "geo/body.h"
#include "globe/experiments.h"

#include <epoxy/gl.h>

// Paper 1: A. Zuev, "Method of synthesis of a seamless textured sphere for visualization in geoinformation and
// cartographic systems", 2023.

namespace terrella::bench {
namespace {

using truth::ZoneError;

constexpr std::size_t kGlobeBytes = 192UL << 20;  // per globe, as there are many: 490 tiles

struct Size {
  int side_px;
  int rays_per_side;
  int rounds;
};
Size size_of(Effort effort) {
  if (effort == Effort::quick) return {192, 4, 2};
  return {1024, 8, effort == Effort::full ? 15 : 9};
}

/// Figures of one method in one view.
struct PolarFigures {
  ZoneError pole, core, twin, mid;  ///< twin: the pole's pixels in the view of mid latitudes
  std::size_t covered = 0;          ///< pixels of ground under a clear view
  std::int64_t triangles = 0, vertices = 0, tiles = 0;
};

class PolarLab {
 public:
  PolarLab(const BenchOptions& options, TestPlanet planet)
      : options_(options),
        size_(size_of(options.effort)),
        viewport_{size_.side_px, size_.side_px},
        planet_(std::move(planet)),
        sphere_(planet_.source.picture, 48, size_.side_px),
        target_(viewport_) {
    for (const PolarMethod& method : polar_methods(options.effort)) {
      methods_.push_back(method);
      globes_.push_back(method.sphere ? nullptr : open(method));
    }
  }

  void measure(const PolarView& view, Report& report) {
    options_.progress(view.name + ": ground truth");
    const truth::TruthImage truth = truth_of(view.camera);
    std::optional<truth::TruthImage> twin;
    if (view.twin) twin = truth_of(*view.twin);
    options_.progress(view.name + ": drawing");
    std::vector<std::size_t> chosen;
    std::vector<PolarFigures> figures;
    for (std::size_t m = 0; m < methods_.size(); ++m) {
      if (!methods_[m].everywhere && !view.swept) continue;
      chosen.push_back(m);
      figures.push_back(judge(m, view, truth, twin ? &*twin : nullptr));
    }
    const std::vector<Subject> subjects = time(view, chosen);
    for (std::size_t k = 0; k < chosen.size(); ++k) add_row(report, view, chosen[k], figures[k], subjects, k);
  }

  [[nodiscard]] const PaperSphere& sphere() const { return sphere_; }

 private:
  std::unique_ptr<Globe> open(const PolarMethod& method) const {
    GlobeOptions globe;
    globe.body = *parse_body("sphere");
    globe.unlit = true;
    globe.texturing = method.texturing;
    globe.squeezed_rows = method.squeezed;
    globe.gpu_bytes = kGlobeBytes;
    std::unique_ptr<Globe> made = open_globe(planet_.tiles.string(), globe);
    Experiments& experiments = Experiments::of(*made);
    experiments.paper_a = method.a;
    experiments.paper_band = method.band;
    return made;
  }

  [[nodiscard]] truth::TruthImage truth_of(const truth::TruthCamera& camera) const {
    return truth::cast_cached(planet_.source, {}, polar_body(), camera,
                              {.width = size_.side_px, .height = size_.side_px, .rays_per_side = size_.rays_per_side},
                              truth_folder(options_));
  }

  /// Draws the method's picture for a camera.
  truth::Picture picture(std::size_t m, const truth::TruthCamera& camera, PolarFigures& figures) {
    if (methods_[m].sphere) {
      sphere_.draw(camera, polar_body().a_m, *methods_[m].sphere);
      figures.triangles = sphere_.triangles();
      figures.vertices = sphere_.vertices();
      return sphere_.read_back();
    }
    const FrameStats stats = settle(*globes_[m], camera, target_, viewport_);
    figures.triangles = stats.triangles;
    figures.vertices = static_cast<std::int64_t>(stats.patches) * kVerticesOfPatch;
    figures.tiles = stats.tiles_wanted;
    return shot(target_, viewport_);
  }

  PolarFigures judge(std::size_t m, const PolarView& view, const truth::TruthImage& truth,
                     const truth::TruthImage* twin) {
    PolarFigures figures;
    const truth::Mask pole = truth::pole_band_mask(truth);
    if (twin != nullptr) figures.twin = truth::masked_error(picture(m, *view.twin, figures), *twin, pole);
    const truth::Picture shown = picture(m, view.camera, figures);
    figures.pole = truth::masked_error(shown, truth, pole);
    figures.core = truth::masked_error(shown, truth, truth::pole_core_mask(truth));
    figures.mid = truth::masked_error(shown, truth, truth::mid_latitude_mask(truth));
    figures.covered = truth::masked_error(shown, truth, truth::clear_mask(truth)).pixels;
    return figures;
  }

  std::vector<Subject> time(const PolarView& view, const std::vector<std::size_t>& chosen) {
    std::vector<Subject> subjects;
    for (const std::size_t m : chosen) {
      const PolarMethod& method = methods_[m];
      if (method.sphere) {
        subjects.push_back(
            {method.name, [this, &view, &method] { sphere_.draw(view.camera, polar_body().a_m, *method.sphere); }});
      } else {
        subjects.push_back({method.name, [this, m] { globes_[m]->render(target_.framebuffer(), viewport_); }});
      }
    }
    time_frames(subjects, size_.rounds);
    return subjects;
  }

  void add_row(Report& report, const PolarView& view, std::size_t m, const PolarFigures& figures,
               const std::vector<Subject>& subjects, std::size_t k) const {
    const PolarMethod& method = methods_[m];
    const auto ratio = [&](std::size_t base) { return median_ratio(subjects[k].ms, subjects[base].ms); };
    const auto cpu_ratio = [&](std::size_t base) { return median_ratio(subjects[k].cpu_ms, subjects[base].cpu_ms); };
    const auto rms = [](const ZoneError& e) { return e.pixels == 0 ? kNoFigure : e.rms; };
    const auto max = [](const ZoneError& e) { return e.pixels == 0 ? kNoFigure : e.max; };
    report.rows.push_back({view.name,
                           method.name,
                           method.has_a_and_band ? method.a : kNoFigure,
                           method.has_a_and_band ? method.band : kNoFigure,
                           method.has_anisotropy ? method.sphere->anisotropy : kNoFigure,
                           median(subjects[k].ms),
                           median(subjects[k].cpu_ms),
                           ratio(0),
                           cpu_ratio(0),
                           ratio(1),
                           cpu_ratio(1),
                           rms(figures.pole),
                           max(figures.pole),
                           rms(figures.core),
                           rms(figures.twin),
                           rms(figures.mid),
                           max(figures.mid),
                           static_cast<double>(figures.pole.pixels) / static_cast<double>(figures.covered),
                           figures.triangles,
                           figures.vertices,
                           figures.tiles});
  }

  static constexpr std::int64_t kVerticesOfPatch = 25L * 25L;

  const BenchOptions& options_;
  Size size_;
  Viewport viewport_;
  TestPlanet planet_;
  PaperSphere sphere_;
  OffscreenTarget target_;
  std::vector<PolarMethod> methods_;
  std::vector<std::unique_ptr<Globe>> globes_;  ///< globes of the methods that use one
};

std::vector<Column> polar_columns() {
  return {{"view", ""},
          {"method", ""},
          {"a", "", 0},
          {"band", "of height"},
          {"anisotropy", "", 0},
          {"time", "ms"},
          {"cpu_time", "ms"},
          {"ratio_plain", "time / plain"},
          {"cpu_ratio_plain", "cpu / plain"},
          {"ratio_vertex", "time / vertex"},
          {"cpu_ratio_vertex", "cpu / vertex"},
          {"rms_pole", "8-bit levels"},
          {"max_pole", "levels", 0},
          {"rms_core", "within 40 px of the pole"},
          {"rms_twin", "the same pixels at 35°"},
          {"rms_mid", "8-bit levels"},
          {"max_mid", "levels", 0},
          {"band_share", "of the ground"},
          {"triangles", ""},
          {"vertices", ""},
          {"tiles", ""}};
}

double figure(const Report& report, std::string_view view, std::string_view method, const char* column) {
  for (const std::vector<Cell>& row : report.rows) {
    if (std::get<std::string>(row[0]) == view && std::get<std::string>(row[1]) == method) {
      return std::get<double>(row[report.column(column)]);
    }
  }
  return kNoFigure;
}

/// Adds the figures that answer the benchmark's questions.
void add_findings(const std::vector<PolarView>& views, Report& report) {
  constexpr double kPartLimit = 1.10, kFilledLimit = 1.25;  // time over `vertex`, by the band's share of the ground
  constexpr double kFilled = 0.5;
  constexpr double kErrorLimit = 0.33;  // 8-bit levels; rounding leaves 0.29
  for (const PolarView& view : views) {
    const auto of_auto = [&](const char* column) { return figure(report, view.name, kAutoGlobe, column); };
    const auto add = [&](const char* what, double value, double limit) {
      if (!std::isnan(value)) report.findings.push_back({view.name + ": " + what, value, limit});
    };
    const bool filled = of_auto("band_share") > kFilled;
    add("time of auto over vertex", of_auto("ratio_vertex"), filled ? kFilledLimit : kPartLimit);
    add("processor time of auto over vertex", of_auto("cpu_ratio_vertex"), filled ? kFilledLimit : kPartLimit);
    add("RMS of auto within 40 px of the pole", of_auto("rms_core"), filled ? kErrorLimit : kNoFigure);
    if (filled) add("RMS of auto in the pole band", of_auto("rms_pole"), kErrorLimit);
    add("RMS of auto in the pole band over the same pixels at 35°", of_auto("rms_pole") / of_auto("rms_twin"),
        kNoFigure);
  }
}

Report measure_polar(const BenchOptions& options, TestPlanet planet) {
  Report report{.name = "polar",
                .title = "Polar texturing: Zuev's sphere (2023) and the globe, time beside error",
                .facts = {{"renderer", renderer_name()}, {"time", timing_method()}},
                .columns = polar_columns()};
  report.facts.emplace_back(
      "picture", fmt::format("noise planet, {}x{}", planet.source.picture.width, planet.source.picture.height));
  PolarLab lab(options, std::move(planet));
  report.facts.emplace_back("Zuev's sphere", fmt::format("n = 48, {} triangles, {} vertices", lab.sphere().triangles(),
                                                         lab.sphere().vertices()));
  std::vector<PolarView> views = polar_views(options.effort);
  std::erase_if(views, [&](const PolarView& view) { return !options.wants(view.name); });
  for (const PolarView& view : views) lab.measure(view, report);
  report.plots = {{.title = "error in the pole band beside time, inscribed, over the pole",
                   .x = "ratio_plain",
                   .y = "rms_pole",
                   .series = "method",
                   .only = {{"view", {"inscribed, pole"}}},
                   .lines = false},
                  {.title = "error in the pole band beside time, 1500 km, beside the pole",
                   .x = "ratio_plain",
                   .y = "rms_pole",
                   .series = "method",
                   .only = {{"view", {"1500 km, beside the pole"}}},
                   .lines = false}};
  add_findings(views, report);
  return report;
}

}  // namespace

Result<Report> bench_polar(const BenchOptions& options) {
  auto planet = noise_test_planet(options);
  if (!planet) return planet.error();
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  try {
    return measure_polar(options, *std::move(planet));
  } catch (const std::exception& error) {
    return Error{error.what()};
  }
}

}  // namespace terrella::bench
