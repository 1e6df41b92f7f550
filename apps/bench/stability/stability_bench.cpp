#include <epoxy/gl.h>

#include <algorithm>
#include <array>

#include "apps/bench/benches.h"
#include "apps/bench/frame_timing.h"
#include "apps/bench/stability/check.h"
#include "render/gl/offscreen.h"

namespace terrella::bench {
namespace {

struct Section {
  const char* name;
  Status (*run)(const StabilityOptions&, Checks&);
};
constexpr std::array kSections{Section{"functions", check_functions}, Section{"depth", check_depth},
                               Section{"jitter", check_jitter},       Section{"places", check_places},
                               Section{"geodesy", check_geodesy},     Section{"same pixels", check_same_pixels}};

std::string words_for(ShaderFunctions functions) { return functions == ShaderFunctions::own ? "own" : "driver's"; }

Plot plot_of(const char* test, const char* title, bool log_x) {
  return {.title = title,
          .x = "at",
          .y = "error",
          .series = "subject",
          .log_x = log_x,
          .log_y = true,
          .only = {{"test", {test}}}};
}

Report report_of(const Checks& checks) {
  Report report;
  report.name = "stability";
  report.title = "Stability: a self-test on this machine's GPU";
  report.columns = {{"test", ""},       {"subject", ""},   {"at", "", -1}, {"at_unit", ""}, {"error", "", -1},
                    {"error_unit", ""}, {"limit", "", -1}, {"passed", ""}, {"time", "ms"}};
  for (const Check& check : checks) {
    const bool held = check.limit == check.limit;
    const std::string passed = !check.passed() ? "FAIL" : held ? "pass" : "-";
    report.rows.push_back(
        {check.test, check.subject, check.at, check.at_unit, check.error, check.unit, check.limit, passed, check.ms});
    report.failed = report.failed || !check.passed();
  }
  const auto failures = std::ranges::count_if(checks, [](const Check& check) { return !check.passed(); });
  report.findings.push_back({"checks that failed", static_cast<double>(failures), 0.0});
  report.plots = {plot_of("jitter", "jitter, px, by the eye's height, m", true),
                  plot_of("depth, smallest gap", "smallest gap that depth resolves, m, by distance, m", true),
                  plot_of("texture coordinates", "texture coordinates off, texels, by level", false)};
  return report;
}

}  // namespace

Result<Report> bench_stability(const BenchOptions& options) {
  const auto context = HeadlessContext::create();
  if (!context) return context.error();
  const Result<ShaderFunctions> chosen = choose_shader_functions();
  if (!chosen) return chosen.error();
  const StabilityOptions stability{.functions = options.functions.value_or(*chosen),
                                   .quick = options.effort == Effort::quick};
  Checks checks;
  for (const Section& section : kSections) {
    if (!options.wants(section.name)) continue;
    options.progress(section.name);
    if (Status done = section.run(stability, checks); !done) return done.error();
  }
  Report report = report_of(checks);
  report.facts = {{"renderer", renderer_name()},
                  {"OpenGL", reinterpret_cast<const char*>(glGetString(GL_VERSION))},
                  {"functions the engine chooses here", words_for(*chosen)},
                  {"functions measured with", words_for(stability.functions)}};
  return report;
}

}  // namespace terrella::bench
