#pragma once

#include <CLI/App.hpp>
#include <string>

namespace terrella {

/// Exit codes of every subcommand.
enum ExitCode : int { kDone = 0, kFailed = 1, kWrongUsage = 2, kDoneInPart = 3 };

/// Each adds its subcommand to the program. When the command line names it, it runs at the end of the parse and
/// leaves its exit code in `exit_code`, which must outlive the parse. A wrong command line is a CLI::ParseError.
/// thread: main
void add_bench_command(CLI::App& app, int& exit_code);
void add_cut_command(CLI::App& app, int& exit_code);
void add_info_command(CLI::App& app, int& exit_code);
void add_merge_command(CLI::App& app, int& exit_code);
void add_preload_command(CLI::App& app, int& exit_code);
void add_render_command(CLI::App& app, int& exit_code);
void add_view_command(CLI::App& app, int& exit_code);

/// Says on standard error why a subcommand failed. Returns kFailed.
int fail(const char* command, const std::string& why);

}  // namespace terrella
