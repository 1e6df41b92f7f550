#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "apps/open_scene/options/option_checks.h"
#include "apps/process/console.h"
#include "apps/process/open_files.h"
#include "apps/process/process.h"
#include "apps/process/stop_signals.h"
#include "apps/program/commands.h"
#include "apps/serve/descriptions.h"
#include "apps/serve/http_server.h"
#include "apps/serve/tile_server.h"

namespace terrella {
namespace {

constexpr const char* kServeExamples =
    "Examples:\n"
    "  terrella serve planet.gpkg                          for programs on this machine, at http://127.0.0.1:8080/\n"
    "  terrella serve alps=tiles.pmtiles mars.mbtiles --port 9000\n"
    "  terrella serve scan.tif --bind 0.0.0.0              for the network, tiles made on request\n"
    "The page at that address lists XYZ, TMS, WMTS, TileJSON and PMTiles. Ctrl + C ends the server.";

constexpr int kDefaultPort = 8080;
constexpr int kMostConnections = 4096;
constexpr int kFilesAConnection = 2;  // its socket, and the archive it reads

struct ServeCommand {
  std::vector<std::string> sets;
  HttpServerOptions http{.port = kDefaultPort};
  bool json = false;
};

Status print_addresses(const ServeCommand& command, const HttpServer& server, const std::vector<ServedSet>& sets) {
  if (command.json) {
    print_result("{}\n", addresses_json(sets, server.address(), server.port()));
  } else {
    print_result("{}/\n", server.address());
    for (const ServedSet& set : sets) print_result("{}\n", tile_template(set, server.address()));
  }
  return flush_standard_output();
}

int run_serve(ServeCommand command) {
  const StopSignals signals;
  auto sets = open_served_sets(command.sets);
  if (!sets) return fail("serve", sets.error().message);
  const TileServer tiles(*std::move(sets),
                         [](const std::string& line) { print_message("terrella serve: {}\n", line); });
  command.http.connections = connections_that_fit(kMostConnections * kFilesAConnection) / kFilesAConnection;
  const auto server = HttpServer::start(command.http, [&](const WebRequest& request) { return tiles.answer(request); });
  if (!server) return fail("serve", server.error().message);
  if (!(*server)->is_loopback()) {
    print_message("terrella serve: {} is visible to the network; without --bind only this machine sees it\n",
                  (*server)->address());
  }
  if (Status printed = print_addresses(command, **server, tiles.sets()); !printed) {
    return fail("serve", printed.error().message);
  }
  constexpr std::chrono::milliseconds kLook{50};
  while (!StopSignals::came()) std::this_thread::sleep_for(kLook);
  return kDone;
}

}  // namespace

void add_serve_command(CLI::App& app, int& exit_code) {
  CLI::App& sub = *app.add_subcommand("serve", "Serve tile sets and rasters to other programs by HTTP");
  sub.footer(kServeExamples);
  const auto command = std::make_shared<ServeCommand>();
  sub.add_option("SETS", command->sets,
                 "Folders of tiles, GeoPackages, caches, MBTiles or PMTiles files, or pictures; NAME=SET chooses the "
                 "name in addresses")
      ->required()
      ->type_name("[NAME=]SET");
  sub.add_option("--port", command->http.port, "Listen on this port; 0 chooses a free one (default: 8080)")
      ->check(whole_number_in(0, 65535))
      ->type_name("N");
  sub.add_option("--bind,--host", command->http.host,
                 "Listen on this address (default: 127.0.0.1, this machine alone; 0.0.0.0 is every network)")
      ->type_name("ADDRESS");
  sub.add_flag("--json", command->json, "Print the addresses as one JSON object once the server listens");
  sub.callback([command, &exit_code] { exit_code = run_serve(*command); });
}

}  // namespace terrella
