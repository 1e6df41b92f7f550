#pragma once

#include <CLI/App.hpp>

#include "streaming/remote/remote_options.h"

namespace terrella {

/// Adds the options for remote tile sets to a subcommand; `remote` must outlive the parse. thread: main
void add_remote_set_options(CLI::App& app, RemoteOptions& remote);

/// Accepts an instant or a series of instants, as TimeSteps::parse() reads it. thread: any
[[nodiscard]] CLI::Validator time_series();

}  // namespace terrella
