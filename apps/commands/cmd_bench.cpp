#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <array>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/bench/benches.h"
#include "apps/bench/report/report_files.h"
#include "apps/bench/report/report_page.h"
#include "apps/open_scene/open_imagery.h"
#include "apps/open_scene/options/option_checks.h"
#include "apps/process/console.h"
#include "apps/process/stop_signals.h"
#include "apps/process/write_file.h"
#include "apps/program/commands.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

struct NamedBench {
  const char* name;
  Result<bench::Report> (*run)(const bench::BenchOptions&);
};
constexpr std::array kBenches{
    NamedBench{"views", bench::bench_views},         NamedBench{"polar", bench::bench_polar},
    NamedBench{"accuracy", bench::bench_accuracy},   NamedBench{"traverse", bench::bench_traverse},
    NamedBench{"stream", bench::bench_stream},       NamedBench{"objects", bench::bench_objects},
    NamedBench{"stability", bench::bench_stability}, NamedBench{"growth", bench::bench_growth},
    NamedBench{"features", bench::bench_features},   NamedBench{"limb", bench::bench_limb},
    NamedBench{"layers", bench::bench_layers}};
constexpr NamedBench kPrograms{"programs", bench::bench_programs};  // needs commands, so `all` has it not

constexpr const char* kBenchExamples =
    "views      time and error of the table of the README: the globe against a plain sphere, all texturings\n"
    "polar      time and error of texturing at the poles: the globe against the textured sphere of A. Zuev\n"
    "           (Method of synthesis of a seamless textured sphere for visualization in geoinformation and\n"
    "           cartographic systems, 2023)\n"
    "accuracy   cost and remaining error of tessellation, error threshold, and tile columns at a pole\n"
    "traverse   selection, draws, uploads and wasted drawing on flights\n"
    "stream     time, requests, bytes and screen error from an empty cache to a settled view\n"
    "objects    time of edits of single objects, beside scenes set anew, and of picks\n"
    "stability  a pass-or-fail self-test on this GPU: functions, depth, jitter, coordinates, geodesy, same pixels\n"
    "growth     cost against size: depth of a set, pixels, layers, tiles in a cache (--full: up to 10^7)\n"
    "features   cost of each feature of a frame: stereo, sky, relief, layers, spheres, numbers\n"
    "layers     image layers in three lights, as ratios to the bare globe\n"
    "limb       the limb beside the same pictures drawn larger, with a sky and without\n"
    "programs   time and memory of shell commands that take turns, as ratios to the first one\n"
    "all        every one of these but programs; one page, index.html, with all tables and plots, to attach to a "
    "report\n"
    "Examples:\n"
    "  terrella bench polar --out results        results/polar.csv, .json, .gnuplot and .png\n"
    "  terrella bench polar --quick --json       a trial run of a few seconds\n"
    "  terrella bench stability                  exit code 1 if a figure is over its limit\n"
    "  terrella bench programs 'terrella cut a.jpg -o a.gpkg' 'vips dzsave a.jpg a' --reset 'rm -rf a.gpkg a_files'";

struct BenchCommand {
  std::string name;
  std::string out = "terrella-bench";
  std::string work, only, functions = "auto", reset;
  std::vector<std::string> commands;
  int rounds = 5;
  bool quick = false, full = false, json = false;
};

/// The benchmarks that a name stands for: one, or all.
std::span<const NamedBench> benches_named(const std::string& name) {
  if (name == "all") return kBenches;
  std::string names;
  if (name == kPrograms.name) return {&kPrograms, 1};
  for (const NamedBench& bench : kBenches) {
    if (name == bench.name) return {&bench, 1};
    names += std::string(bench.name) + '|';
  }
  throw CLI::ValidationError("NAME", "'" + name + "' is none of " + names + "programs|all");
}

Result<bench::BenchOptions> bench_options(const BenchCommand& command) {
  bench::BenchOptions options;
  if (command.quick) options.effort = bench::Effort::quick;
  options.only = command.only;
  options.commands = command.commands;
  options.reset = command.reset;
  options.rounds = command.rounds;
  if (command.functions == "driver") options.functions = ShaderFunctions::driver;
  if (command.functions == "own") options.functions = ShaderFunctions::own;
  if (command.full) options.effort = bench::Effort::full;
  const Result<fs::path> cache = picture_cache_folder(command.work);
  if (!cache) return cache.error();
  options.work = command.work.empty() ? *cache / "bench" : *cache;
  options.goes_on = [] { return !StopSignals::came(); };
  return options;
}

/// Runs a benchmark, prints its table, and writes its files.
Result<bench::Report> run_one(const NamedBench& chosen, bench::BenchOptions options, const BenchCommand& command) {
  options.progress = [&](const std::string& doing) {
    if (StopSignals::came()) throw std::runtime_error("stopped; nothing was written");
    print_message("bench {}: {}\n", chosen.name, doing);
  };
  Result<bench::Report> report = chosen.run(options);
  if (!report) return report;
  if (report->rows.empty()) {
    return Error{fmt::format("no view of {} has '{}' in its name", chosen.name, command.only)};
  }
  const Result<bench::ReportFiles> files = bench::write_report(*report, command.out);
  if (!files) return files.error();
  if (!command.json) print_result("{}", as_text(*report));
  for (const fs::path& file : files->written) print_message("bench {}: wrote {}\n", chosen.name, file.string());
  if (!files->remark.empty()) print_message("bench {}: {}\n", chosen.name, files->remark);
  return report;
}

/// One JSON object, or an array of those of all benchmarks.
void print_json(const std::vector<bench::PageEntry>& entries, bool all) {
  std::string text;
  for (const bench::PageEntry& entry : entries) text += (text.empty() ? "" : ",\n") + as_json(entry.report);
  print_result("{}", all ? "[" + text + "]\n" : text);
}

Status write_page(const std::vector<bench::PageEntry>& entries, const std::string& folder) {
  const fs::path file = fs::path(folder) / "index.html";
  const std::string page = bench::as_page(bench::machine_facts(), entries);
  if (Status written = write_file(file, std::as_bytes(std::span(page))); !written) return written;
  print_message("bench: wrote {}\n", file.string());
  return Done{};
}

int run(const BenchCommand& command) {
  const std::span<const NamedBench> chosen = benches_named(command.name);
  const bool all = chosen.size() > 1;
  if ((command.name == kPrograms.name) == command.commands.empty()) {
    throw CLI::ValidationError("COMMAND", "programs measures commands, and nothing else does");
  }
  if (all && !command.only.empty()) throw CLI::ValidationError("--only", "name one benchmark with it");
  const Result<bench::BenchOptions> options = bench_options(command);
  if (!options) return fail("bench", options.error().message);
  const StopSignals signals;
  // Fail before minutes of measuring, not after.
  if (const Status made = bench::make_folder(command.out); !made) return fail("bench", made.error().message);
  std::vector<bench::PageEntry> entries;
  bool failed = false;
  for (const NamedBench& bench : chosen) {
    Result<bench::Report> report = run_one(bench, *options, command);
    if (!report && (!all || StopSignals::came())) return fail("bench", report.error().message);
    failed = failed || !report || report->failed;
    if (report) {
      entries.push_back({.report = *report, .svg = all ? bench::draw_svg(*report, command.out) : ""});
    } else {
      print_message("terrella bench: {}: {}\n", bench.name, report.error().message);
      entries.push_back(
          {.report = {.name = bench.name, .title = {}, .facts = {}, .columns = {}}, .failure = report.error().message});
    }
  }
  if (command.json) print_json(entries, all);
  if (all) {
    if (const Status page = write_page(entries, command.out); !page) return fail("bench", page.error().message);
  }
  return failed ? kFailed : kDone;
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
  CLI::App& sub = *app.add_subcommand("bench", "Measure speed and error; write a table and a plot");
  sub.footer(kBenchExamples);
  const auto command = std::make_shared<BenchCommand>();
  sub.add_option("NAME", command->name, "The measurement to run")
      ->required()
      ->type_name("views|polar|accuracy|traverse|stream|objects|stability|growth|features|limb|programs|all");
  sub.add_option("COMMAND", command->commands, "Shell commands that programs measures")->type_name("TEXT ...");
  sub.add_option("--rounds", command->rounds, "Run each COMMAND this many times")
      ->check(whole_number_in(1, 1000))
      ->capture_default_str();
  sub.add_option("--reset", command->reset, "Run this before each COMMAND and do not measure it");
  sub.add_option("-o,--out", command->out, "Write NAME.csv, NAME.json, NAME.gnuplot and NAME.png to this folder")
      ->capture_default_str();
  sub.add_option("--work", command->work,
                 "Keep the planet, its tiles and the ground truth in this folder between runs (default: in the cache)");
  sub.add_option("--only", command->only,
                 "Run only the rows (views, flights, frames, grounds) whose name contains this text");
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
