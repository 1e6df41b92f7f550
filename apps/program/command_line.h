#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace terrella {

/// Appends an option with its value. An empty value is an argument of its own, because CLI11 takes none after "=" and
/// would take the next option. thread: any
void append_option(const std::string& name, const std::string& value, std::vector<std::string>& arguments);

/// Parses arguments without the program's name and runs the subcommand that they name. The subcommands of `app` store
/// their exit code in `exit_code`. Reports a wrong command line and returns the exit code. thread: main
int run_command_line(CLI::App& app, std::vector<std::string> arguments, const int& exit_code);

}  // namespace terrella
