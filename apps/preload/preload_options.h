#pragma once

#include <CLI/App.hpp>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "apps/preload/day_hours.h"
#include "apps/preload/preload_area.h"
#include "geo/camera.h"
#include "streaming/http/http_fetcher.h"
#include "streaming/preload/tile_plan.h"
#include "streaming/remote/remote_options.h"

namespace terrella {

/// Options of `terrella preload`; the parse has checked every value.
struct PreloadCommand {
  Url source;
  std::string output;
  PreloadArea area;
  std::string flight;
  Viewport size{.width_px = 1920, .height_px = 1080};
  std::optional<Shard> shard;
  std::vector<std::string> times;  ///< instants to load (preload_instants()); empty: that of the source
  RemoteOptions remote;
  HttpOptions http;
  std::optional<DayHours> between;  ///< when tiles may be requested; none: always
  double timeout_s = 600.0;         ///< longest wait for a server before the first tile is requested
  std::optional<double> refresh_older_than_days;
  std::size_t cache_size_mb = 0;
  std::string missing_file;
  std::string stored_file;
  bool dry_run = false;
  bool release = false;
  bool offline = false;
  bool json = false;
};

/// Adds SOURCE and the options to the subcommand; `command` must outlive the parse. thread: main
void add_preload_options(CLI::App& app, PreloadCommand& command);

/// Checks combinations of options; an error means wrong usage.
[[nodiscard]] Status check_together(const PreloadCommand& command);

}  // namespace terrella
