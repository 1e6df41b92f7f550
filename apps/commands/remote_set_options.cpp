#include "apps/commands/remote_set_options.h"

#include "apps/commands/option_checks.h"
#include "streaming/http/http_headers.h"
#include "tiles/tile_grid.h"

namespace terrella {

namespace {

/// Refuses what no request could be sent with, before any is.
CLI::Validator sendable_header() {
  return {[](const std::string& header) {
            const Status sendable = http::check_request_header(header);
            return sendable ? std::string() : sendable.error().message;
          },
          ""};
}

}  // namespace

void add_remote_set_options(CLI::App& app, RemoteOptions& remote) {
  app.add_option("--layer", remote.layer, "Of a WMTS");
  app.add_option("--matrix-set", remote.matrix_set, "Of a WMTS layer that has several");
  app.add_option("--style", remote.style, "Of a WMTS layer");
  app.add_option("--layer-time", remote.time, "Of a WMTS layer that has several times, ISO 8601");
  app.add_option("--root-span", remote.root_span_deg, "Of a URL template: degrees that a level-0 tile spans (180)")
      ->check(number_in(0.001, 1e4));
  app.add_option("--tile-size", remote.tile_px, "Of a URL template: pixels a side (256)")
      ->check(whole_number_in(16, 4096));
  app.add_option("--max-level", remote.max_level,
                 "Of a URL template: the finest that the server has (default: the last of --levels)")
      ->check(whole_number_in(0, kMaxTileLevel));
  app.add_option("--header", remote.headers,
                 "Sent with each request, to the source's scheme, host and port alone; never stored or printed")
      ->type_name("'K: V'")
      ->check(sendable_header())
      ->allow_extra_args(false);
}

}  // namespace terrella
