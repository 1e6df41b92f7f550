#include "apps/open_scene/options/remote_set_options.h"

#include <chrono>
#include <span>
#include <string_view>

#include "apps/open_scene/options/option_checks.h"
#include "base/iso_time.h"
#include "base/number.h"
#include "base/time_steps.h"
#include "streaming/http/http_headers.h"
#include "tiles/tile_grid.h"

namespace terrella {

namespace {

/// Refuses headers that no request could carry, before any request is sent.
CLI::Validator sendable_header() {
  return {[](const std::string& header) {
            const Status sendable = http::check_request_header(header);
            return sendable ? std::string() : sendable.error().message;
          },
          ""};
}

/// Accepts times of ISO 8601, which begin with a digit, periods, and the words that servers have for a time.
CLI::Validator is_time() {
  return {[](const std::string& text) -> std::string {
            const bool iso = !text.empty() && (std::string_view("0123456789P+-").find(text.front()) != text.npos);
            if (iso || text == "default" || names_newest(text)) return {};
            return in_quotes(text) + " is no time; write it as 2024-07-01 or 2024-07-01T12:00:00Z";
          },
          ""};
}

}  // namespace

CLI::Validator time_series() {
  return {[](const std::string& text) -> std::string {
            using std::chrono::floor;
            const UtcTime now = floor<std::chrono::milliseconds>(std::chrono::system_clock::now());
            const auto read = TimeSteps::parse(std::span(&text, 1), now);
            return read ? std::string() : read.error().message;
          },
          ""};
}

void add_remote_set_options(CLI::App& app, RemoteOptions& remote) {
  app.add_option("--layer", remote.layer, "Choose the WMTS or WMS layer");
  app.add_option("--matrix-set", remote.matrix_set, "Choose the tile matrix set if the WMTS layer has several");
  app.add_option("--style", remote.style, "Choose the style of the WMTS or WMS layer");
  app.add_option("--layer-time", remote.time,
                 "Choose the time (ISO 8601) of a layer that has several (default: the server's, or the newest)")
      ->check(is_time());
  app.add_option("--layer-times", remote.times, "Set the times of a URL template with {time} or {time:%Y-%m-%d}")
      ->type_name("A/B/P1D[,...]")
      ->delimiter(',')
      ->check(time_series())
      ->allow_extra_args(false);
  app.add_option("--root-span", remote.root_span_deg,
                 "Set the degrees that a level-0 tile of a URL template or WMS spans (default: 180)")
      ->check(number_in(0.001, 1e4));
  app.add_option("--tile-size", remote.tile_px,
                 "Set the side of the tiles of a URL template or WMS in pixels (default: 256; WMS: 512)")
      ->check(whole_number_in(16, 4096));
  app.add_option("--max-level", remote.max_level,
                 "Set the finest level of a URL template's server (default: the last of --levels)")
      ->check(whole_number_in(0, kMaxTileLevel));
  app.add_option(
         "--header", remote.headers,
         "Send this header with each request to the source's scheme, host and port only; never stored or printed")
      ->type_name("'K: V'")
      ->check(sendable_header())
      ->allow_extra_args(false);
}

}  // namespace terrella
