#pragma once

#include <CLI/App.hpp>

#include "streaming/remote/remote_options.h"

namespace terrella {

/// Adds to a subcommand what a person may say about a remote set; `remote` must outlive the parse. thread: main
void add_remote_set_options(CLI::App& app, RemoteOptions& remote);

}  // namespace terrella
