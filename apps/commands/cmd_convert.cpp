#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/open_scene/options/option_checks.h"
#include "apps/process/console.h"
#include "apps/process/progress.h"
#include "apps/process/stop_signals.h"
#include "apps/program/commands.h"
#include "streaming/convert/convert.h"

namespace terrella {
namespace {

constexpr const char* kConvertExamples =
    "Examples:\n"
    "  terrella convert city.mbtiles city.pmtiles          one file for a web server, in Web Mercator\n"
    "  terrella convert planet.gpkg tiles                  a folder tiles/{z}/{x}/{y}.jpg with tileset.json\n"
    "  terrella convert preloaded.gpkg trip.mbtiles        the tiles of a cache\n"
    "Tiles keep their places and their bytes, and the set its name, attribution and bounds.";

struct ConvertCommand {
  std::string from, to;
  Projection projection = Projection::web_mercator;
  bool force = false;
  bool json = false;
};

void print_summary(const ConvertCommand& command, const ConvertSummary& summary) {
  const int tile_px = summary.info.grid.tile_px;
  if (command.json) {
    const nlohmann::ordered_json result{{"output", command.to},           {"input", command.from},
                                        {"tiles", summary.tiles},         {"bytes", summary.bytes},
                                        {"blank", summary.blank},         {"tile_size", tile_px},
                                        {"min_level", summary.min_level}, {"max_level", summary.max_level}};
    // Paths may contain bytes that are not UTF-8.
    print_result("{}\n", result.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
    return;
  }
  print_result("{}: {} tiles of {} pixels, levels {} to {}, {:.1f} MB{}\n", command.to, summary.tiles, tile_px,
               summary.min_level, summary.max_level, static_cast<double>(summary.bytes) * 1e-6,
               summary.blank > 0 ? fmt::format("; {} empty tiles left out", summary.blank) : "");
}

int run_convert(const ConvertCommand& command) {
  const StopSignals signals;
  Result<ConvertSummary> summary = Error{};
  {
    Progress progress("converting into " + command.to);
    summary = convert({.from = command.from,
                       .to = command.to,
                       .force = command.force,
                       .geodetic_mbtiles = command.projection == Projection::equirectangular,
                       .progress = [&](std::int64_t done, std::int64_t total) {
                         progress.show(done, total);
                         return !StopSignals::came();
                       }});
  }
  if (!summary) return fail("convert", summary.error().message);
  print_summary(command, *summary);
  return kDone;
}

}  // namespace

void add_convert_command(CLI::App& app, int& exit_code) {
  CLI::App& sub = *app.add_subcommand("convert", "Write a tile set in another format, without decoding a tile");
  sub.footer(kConvertExamples);
  const auto command = std::make_shared<ConvertCommand>();
  sub.add_option("INPUT", command->from, "A folder of tiles, a GeoPackage, a cache, an MBTiles or a PMTiles file")
      ->required()
      ->type_name("TILESET");
  sub.add_option("OUTPUT", command->to,
                 "Write to a GeoPackage, an MBTiles or a PMTiles file by the ending of the name, else to a folder. "
                 "MBTiles and PMTiles take pictures in Web Mercator alone")
      ->required()
      ->type_name("OUT.gpkg|.mbtiles|.pmtiles|DIR");
  add_choice<Projection>(sub, "--projection", command->projection,
                         {{"equirectangular", Projection::equirectangular}, {"web-mercator", Projection::web_mercator}},
                         "Set the projection of an MBTiles file that does not state it (default: web-mercator)");
  sub.add_flag("--force", command->force, "Replace a tile set that cut or convert wrote; keep other files");
  sub.add_flag("--json", command->json, "Print the result as one JSON object");
  sub.callback([command, &exit_code] { exit_code = run_convert(*command); });
}

}  // namespace terrella
