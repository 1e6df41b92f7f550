#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <array>
#include <memory>
#include <stdexcept>
#include <string>

#include "apps/bench/benches.h"
#include "apps/bench/report_files.h"
#include "apps/commands/commands.h"
#include "apps/setup/console.h"
#include "apps/setup/open_imagery.h"
#include "apps/setup/stop_signals.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

struct NamedBench {
  const char* name;
  Result<bench::Report> (*run)(const bench::BenchOptions&);
};
constexpr std::array kBenches{
    NamedBench{"polar", bench::bench_polar},       NamedBench{"accuracy", bench::bench_accuracy},
    NamedBench{"traverse", bench::bench_traverse}, NamedBench{"stream", bench::bench_stream},
    NamedBench{"objects", bench::bench_objects},   NamedBench{"stability", bench::bench_stability}};

constexpr const char* kBenchExamples =
    "polar      time and error of texturing at the poles: the globe against the textured sphere of A. Zuev\n"
    "           (Method of synthesis of a seamless textured sphere for visualization in geoinformation and\n"
    "           cartographic systems, 2023)\n"
    "accuracy   cost and remaining error of tessellation, error threshold, and tile columns at a pole\n"
    "traverse   selection, draws, uploads and wasted drawing on flights\n"
    "stream     time, requests, bytes and screen error from an empty cache to a settled view\n"
    "objects    time of edits of single objects, beside scenes set anew, and of picks\n"
    "stability  a pass-or-fail self-test on this GPU: functions, depth, jitter, coordinates, geodesy, same pixels\n"
    "Examples:\n"
    "  terrella bench polar --out results        results/polar.csv, .json, .gnuplot and .png\n"
    "  terrella bench polar --quick --json       a trial run of a few seconds\n"
    "  terrella bench stability                  exit code 1 if a figure is over its limit";

struct BenchCommand {
  std::string name;
  std::string out = "terrella-bench";
  std::string work, only, functions = "auto";
  bool quick = false, full = false, json = false;
};

const NamedBench& bench_named(const std::string& name) {
  std::string names;
  for (const NamedBench& bench : kBenches) {
    if (name == bench.name) return bench;
    names += (names.empty() ? "" : "|") + std::string(bench.name);
  }
  throw CLI::ValidationError("NAME", "'" + name + "' is none of " + names);
}

int run(const BenchCommand& command) {
  const NamedBench& chosen = bench_named(command.name);
  bench::BenchOptions options;
  if (command.quick) options.effort = bench::Effort::quick;
  options.only = command.only;
  if (command.functions == "driver") options.functions = ShaderFunctions::driver;
  if (command.functions == "own") options.functions = ShaderFunctions::own;
  if (command.full) options.effort = bench::Effort::full;
  const Result<fs::path> cache = picture_cache_folder(command.work);
  if (!cache) return fail("bench", cache.error().message);
  options.work = command.work.empty() ? *cache / "bench" : *cache;
  const StopSignals signals;
  options.goes_on = [] { return !StopSignals::came(); };
  options.progress = [&](const std::string& doing) {
    if (StopSignals::came()) throw std::runtime_error("stopped; nothing was written");
    print_message("bench {}: {}\n", chosen.name, doing);
  };
  // Fail before minutes of measuring, not after.
  if (const Status made = bench::make_folder(command.out); !made) return fail("bench", made.error().message);
  const Result<bench::Report> report = chosen.run(options);
  if (!report) return fail("bench", report.error().message);
  if (report->rows.empty())
    return fail("bench", fmt::format("no view of {} has '{}' in its name", command.name, command.only));
  const Result<bench::ReportFiles> files = bench::write_report(*report, command.out);
  if (!files) return fail("bench", files.error().message);
  print_result("{}", command.json ? as_json(*report) : as_text(*report));
  for (const fs::path& file : files->written) print_message("bench {}: wrote {}\n", chosen.name, file.string());
  if (!files->remark.empty()) print_message("bench {}: {}\n", chosen.name, files->remark);
  return report->failed ? kFailed : kDone;
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  CLI::App& sub = *app.add_subcommand("bench", "Measure speed and error; write a table and a plot");
  sub.footer(kBenchExamples);
  const auto command = std::make_shared<BenchCommand>();
  sub.add_option("NAME", command->name, "The measurement to run")
      ->required()
      ->type_name("polar|accuracy|traverse|stream|objects|stability");
  sub.add_option("-o,--out", command->out, "Write NAME.csv, NAME.json, NAME.gnuplot and NAME.png to this folder")
      ->capture_default_str();
  sub.add_option("--work", command->work,
                 "Keep the planet, its tiles and the ground truth in this folder between runs (default: in the cache)");
  sub.add_option("--only", command->only, "Run only the views or flights whose name contains this text");
  sub.add_option("--functions", command->functions,
                 "Choose the shaders' trigonometric functions for stability; with auto the engine chooses")
      ->check(CLI::IsMember({"auto", "driver", "own"}))
      ->capture_default_str();
  CLI::Option* quick =
      sub.add_flag("--quick", command->quick, "Finish in seconds with small pictures; do not quote these figures");
  sub.add_flag("--full", command->full, "Run the whole grid of parameters and views")->excludes(quick);
  sub.add_flag("--json", command->json, "Print the result as one JSON object");
  sub.callback([command, &exit_code] { exit_code = run(*command); });
}

}  // namespace terrella
