#include <fmt/core.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/process/console.h"
#include "apps/process/progress.h"
#include "apps/process/stop_signals.h"
#include "apps/program/commands.h"
#include "streaming/convert/merge_into.h"
#include "streaming/cut/output/tile_writer.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

struct MergeCommand {
  std::vector<std::string> caches;
  std::string output;
  bool json = false;
};

constexpr const char* kMergeExamples =
    "Examples:\n"
    "  terrella merge shard-*.gpkg -o planet.gpkg          join what several machines preloaded\n"
    "  terrella merge old.gpkg new.gpkg -o old.gpkg        add one cache to another\n"
    "  terrella merge shard-*.gpkg -o planet.pmtiles       one file for a web server, in Web Mercator\n"
    "A tile wins over a missing-tile record; otherwise the later record wins. Levels may differ. Pinned tiles stay "
    "pinned.";

void print_summary(const MergeCommand& command, const MergeSummary& summary) {
  if (command.json) {
    const nlohmann::ordered_json result{{"output", command.output},
                                        {"caches", command.caches},
                                        {"tiles", summary.tiles},
                                        {"absences", summary.missing},
                                        {"dropped", summary.dropped}};
    // Paths may contain bytes that are not UTF-8.
    print_result("{}\n", result.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  print_result("{}: {} tiles and {} missing from {} caches, {} older records left out\n", command.output, summary.tiles,
               summary.missing, command.caches.size(), summary.dropped);
}

int run_merge(const MergeCommand& command) {
  const std::vector<fs::path> caches(command.caches.begin(), command.caches.end());
  const StopSignals signals;
  Result<MergeSummary> summary = Error{};
  {
    Progress progress("merging into " + command.output);
    const auto merge = is_web_format(command.output) ? merge_into : merge_caches;
    summary = merge(caches, command.output, [&](std::int64_t done, std::int64_t total) {
      progress.show(done, total);
      return !StopSignals::came();
    });
  }
  if (!summary) return fail("merge", summary.error().message);
  print_summary(command, *summary);
  return kDone;
}

}  // namespace

void add_merge_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("merge", "Join caches of one source without loss");
  command->footer(kMergeExamples);
  const auto options = std::make_shared<MergeCommand>();
  command->add_option("CACHE", options->caches, "Caches that preload or view filled from one source")
      ->required()
      ->type_name("CACHE...");
  command
      ->add_option("-o,--output", options->output,
                   "Write this cache, or an MBTiles or a PMTiles file, which take pictures in Web Mercator alone; an "
                   "existing file is replaced only if it is one of the inputs")
      ->required()
      ->type_name("OUT.gpkg|.mbtiles|.pmtiles");
  command->add_flag("--json", options->json, "Print the result as one JSON object");
  command->callback([options, &exit_code] { exit_code = run_merge(*options); });
}

}  // namespace terrella
