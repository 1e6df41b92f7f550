#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "apps/bench/benches.h"
#include "apps/bench/frame_timing.h"
#include "apps/bench/growth/growth_rows.h"
#include "render/gl/offscreen.h"

namespace terrella::bench {
namespace {

// Room for the noise of a busy machine, and for costs that do not grow: a time may be half as large again as n log n
// gives.
constexpr double kMostGrowth = 1.5;
// A frame of a deep set beside that of the shallowest set that is as sharp, and a frame from a large cache beside that
// of the smallest.
constexpr double kMostFrame = 1.15;
// Threads that decode at once may wait for each other this much.
constexpr double kMostShare = 1.25;
// Times under this are too short to judge.
constexpr double kLeastJudged_ms = 1.0;

std::vector<Column> growth_columns() {
  return {{"series", ""},
          {"subject", ""},
          {"size", "level, pixels, layers, threads, tiles", 0},
          {"time", "ms", -1},
          {"cpu", "ms of processor time", -1},
          {"selection", "ms", -1},
          {"patches", ""},
          {"tiles", ""},
          {"bytes", "MB", 1},
          {"exponent", "of time by size, since the row before"}};
}

/// log(time) by log(size), between two rows.
double exponent_between(const GrowthRow& from, const GrowthRow& to) {
  return std::log(to.cpu_ms / from.cpu_ms) / std::log(to.size / from.size);
}

/// True if the rows are two sizes of one thing.
bool are_alike(const GrowthRow& a, const GrowthRow& b) { return a.series == b.series && a.subject == b.subject; }

class Findings {
 public:
  explicit Findings(Report& report) : report_(report) {}

  /// Judges the step from one size to the next: the cost of all items may grow as n log n, that of one as log n.
  void judge_step(const GrowthRow& from, const GrowthRow& to) {
    if (from.series == "depth" || from.series == "workers" || (!to.of_one && to.cpu_ms < kLeastJudged_ms)) return;
    const double items = to.of_one ? 1.0 : to.size / from.size;
    const double allowed = items * std::log2(to.size + 1.0) / std::log2(from.size + 1.0);
    const double least = to.of_one ? 0.0 : kLeastJudged_ms;
    report_.findings.push_back({fmt::format("{}, {}, {:g} to {:g}: growth over {}", from.series, to.subject, from.size,
                                            to.size, to.of_one ? "log n" : "n log n"),
                                to.cpu_ms / std::max(from.cpu_ms, least) / allowed, kMostGrowth, ""});
  }

  void judge_workers(const GrowthRow& base, const GrowthRow& row) {
    report_.findings.push_back({fmt::format("{:g} threads: time of a tile over its share of one thread's", row.size),
                                row.ms * row.size / (base.ms * base.size), kMostShare, ""});
  }

  void judge_frame(const GrowthRow& base, const GrowthRow& row) {
    report_.findings.push_back(
        {fmt::format("{}, {}: frame at {:g} over that at {:g}", row.series, row.subject, row.size, base.size),
         row.cpu_ms / base.cpu_ms, kMostFrame, ""});
  }

 private:
  Report& report_;
};

/// False for a set that is too shallow for its view: the deepest set shows the view with other tiles.
bool is_as_sharp(const std::vector<GrowthRow>& rows, const GrowthRow& row) {
  if (row.series != "depth") return true;
  const auto deepest = std::find_if(rows.rbegin(), rows.rend(), [&](const GrowthRow& r) { return are_alike(r, row); });
  return row.tiles == deepest->tiles;
}

void add_findings(const std::vector<GrowthRow>& rows, Report& report) {
  Findings findings(report);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const GrowthRow& row = rows[k];
    if (k > 0 && are_alike(rows[k - 1], row)) findings.judge_step(rows[k - 1], row);
    const auto base = std::ranges::find_if(
        rows, [&](const GrowthRow& other) { return are_alike(other, row) && is_as_sharp(rows, other); });
    if (row.series == "workers" && base->size < row.size) findings.judge_workers(*base, row);
    if ((row.series == "depth" || row.subject == "frame") && base->size < row.size) findings.judge_frame(*base, row);
  }
}

void add_row(const std::vector<GrowthRow>& rows, const GrowthRow& row, Report& report) {
  const auto before = std::find_if(rows.rbegin(), rows.rend(), [&](const GrowthRow& r) { return are_alike(r, row); });
  const double exponent = before == rows.rend() || row.series == "depth" ? kNoFigure : exponent_between(*before, row);
  report.rows.push_back({row.series, row.subject, row.size, row.ms, row.cpu_ms, row.selection_ms, row.patches,
                         row.tiles, row.megabytes, exponent});
}

/// Rows of a cache arrive size by size; a reader wants them subject by subject.
void sort_rows(std::vector<GrowthRow>& rows) {
  const std::vector<GrowthRow> arrived = rows;
  const auto first = [&](const GrowthRow& row) {
    return std::ranges::find_if(arrived, [&](const GrowthRow& other) { return are_alike(other, row); });
  };
  std::ranges::stable_sort(rows, {}, first);
}

Report measure_growth(const BenchOptions& options) {
  Report report{.name = "growth",
                .title = "Cost against size: depth of a set, pixels, layers, tiles in a cache",
                .facts = {{"renderer", renderer_name()},
                          {"time", timing_method()},
                          {"tiles", "of one colour; look-up, store and evict are for one tile"}},
                .columns = growth_columns()};
  std::vector<GrowthRow> arrived;
  const AddRow add = [&](const GrowthRow& row) { arrived.push_back(row); };
  measure_view_growth(options, add);
  measure_cache_growth(options, add);
  sort_rows(arrived);
  std::vector<GrowthRow> rows;
  for (const GrowthRow& row : arrived) {
    add_row(rows, row, report);
    rows.push_back(row);
  }
  add_findings(rows, report);
  const auto plot = [](const char* title, const char* series, bool log) {
    return Plot{.title = title,
                .x = "size",
                .y = "cpu",
                .series = "subject",
                .log_x = log,
                .log_y = log,
                .only = {{"series", {series}}}};
  };
  report.plots = {plot("frame by the set's finest level", "depth", false), plot("frame by pixels", "window", true),
                  plot("frame by layers", "layers", false), plot("cache by tiles", "cache", true),
                  plot("time of a tile by decoder threads", "workers", true)};
  report.plots.back().y = "time";  // sleeping takes no processor time
  return report;
}

}  // namespace

Result<Report> bench_growth(const BenchOptions& options) {
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  try {
    return measure_growth(options);
  } catch (const std::exception& error) {
    return Error{error.what()};
  }
}

}  // namespace terrella::bench
