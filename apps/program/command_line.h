#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace terrella {

/// Parses arguments without the program's name and runs the subcommand that they name. The subcommands of `app` store
/// their exit code in `exit_code`. Reports a wrong command line and returns the exit code. thread: main
int run_command_line(CLI::App& app, std::vector<std::string> arguments, const int& exit_code);

}  // namespace terrella
