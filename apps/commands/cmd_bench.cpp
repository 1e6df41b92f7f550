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
constexpr std::array kBenches{NamedBench{"polar", bench::bench_polar}, NamedBench{"accuracy", bench::bench_accuracy},
                              NamedBench{"traverse", bench::bench_traverse}, NamedBench{"stream", bench::bench_stream},
                              NamedBench{"stability", bench::bench_stability}};

constexpr const char* kBenchExamples =
    "polar      texturing at the poles: paper 1's sphere and the globe, time beside error\n"
    "accuracy   tessellation, error threshold, tile columns at a pole: what each costs, and what it leaves\n"
    "traverse   flights: selection, draws and uploads on the way, and what was drawn in vain\n"
    "stream     from nothing to a settled view: time, requests and bytes beside the error on the screen\n"
    "stability  a self-test on this GPU, pass or fail: functions, depth, jitter, coordinates, geodesy, same pixels\n"
    "Examples:\n"
    "  terrella bench polar --out results        results/polar.csv, .json, .gnuplot and .png\n"
    "  terrella bench polar --quick --json       seconds, to see that it works\n"
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
  // Not after minutes of measuring.
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
  CLI::App& sub = *app.add_subcommand("bench", "Measures speed beside error, and writes a table and a plot");
  sub.footer(kBenchExamples);
  const auto command = std::make_shared<BenchCommand>();
  sub.add_option("NAME", command->name, "What to measure")
      ->required()
      ->type_name("polar|accuracy|traverse|stream|stability");
  sub.add_option("-o,--out", command->out, "Folder for NAME.csv, NAME.json, NAME.gnuplot and NAME.png")
      ->capture_default_str();
  sub.add_option(
      "--work", command->work,
      "Folder that keeps the planet, its tiles and the ground truth from run to run (default: in the cache)");
  sub.add_option("--only", command->only, "Only the views or flights whose name has this text");
  sub.add_option("--functions", command->functions,
                 "stability: whose functions of angles shaders use, auto: as the engine chooses")
      ->check(CLI::IsMember({"auto", "driver", "own"}))
      ->capture_default_str();
  CLI::Option* quick = sub.add_flag("--quick", command->quick, "Seconds: small pictures, figures not to be quoted");
  sub.add_flag("--full", command->full, "The whole grid of parameters and views")->excludes(quick);
  sub.add_flag("--json", command->json, "Print the result as one JSON object");
  sub.callback([command, &exit_code] { exit_code = run(*command); });
}

}  // namespace terrella
