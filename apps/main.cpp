#include <fmt/core.h>
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include <exception>
#include <new>
#include <string>
#include <system_error>

#include "apps/commands/commands.h"
#include "apps/setup/console.h"
#include "apps/setup/process.h"

namespace {

using namespace terrella;

constexpr const char* kProgramExamples =
    "Examples:\n"
    "  terrella view                                  explore the Earth\n"
    "  terrella view moon.jpg --body moon             explore any planet from a 2:1 picture\n"
    "  terrella render -o shot.png --camera 46,7,3e5  save a picture, without display or GPU\n"
    "  terrella cut picture.tif -o planet.gpkg        cut a picture of any size into tiles";

/// Returns the subcommand that the parse reached, or the program; an error message refers to its --help.
const CLI::App& innermost(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : *parsed.front();
}

/// Returns "--option" of "--option=value".
std::string name_part(const std::string& argument) {
  return argument.starts_with('-') ? argument.substr(0, argument.find('=')) : argument;
}

/// Maps CLI11's many exit codes for mistakes to the contract's single code, 2.
int report_parse(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
  const CLI::App& where = innermost(app);
  const std::string command = &where == &app ? app.get_name() : app.get_name() + " " + where.get_name();
  // CLI11 reports missing arguments before unknown ones, so a mistyped name would be reported as a missing one. CLI11
  // also prints all unknown arguments, including the value of a mistyped --header.
  const auto unknown = where.remaining();
  const bool mistyped = (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr ||
                         dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) &&
                        !unknown.empty();
  const std::string message =
      mistyped ? "there is no option or subcommand " + name_part(unknown.front()) : std::string(error.what());
  print_message("{}: {}\n", command, message);
  print_message("See {} --help.\n", command);
  return kWrongUsage;
}

}  // namespace

int terrella::fail(const char* command, const std::string& why) {
  print_message("terrella {}: {}\n", command, why);
  return kFailed;
}

namespace {

int run_program(int argc, char** argv) {
  CLI::App app("Show equirectangular pictures and tile sets of any planet on a globe.", "terrella");
  app.set_version_flag("--version", std::string("terrella ") + TERRELLA_VERSION);
  app.require_subcommand(1);
  app.footer(kProgramExamples);
  int exit_code = kDone;
  add_view_command(app, exit_code);
  add_render_command(app, exit_code);
  add_cut_command(app, exit_code);
  add_preload_command(app, exit_code);
  add_info_command(app, exit_code);
  add_merge_command(app, exit_code);
  add_bench_command(app, exit_code);
  try {
    app.parse(argc, argv);
    return exit_code;
  } catch (const CLI::ParseError& error) {
    return report_parse(app, error);
  }
}

int run_guarded(int argc, char** argv) {
  try {
    return run_program(argc, argv);
  } catch (const std::bad_alloc&) {
    tell_failure(kOutOfMemory);
  } catch (const std::system_error& error) {
    const bool threads = error.code() == std::errc::resource_unavailable_try_again;
    tell_failure(threads ? kOutOfThreads : error.what());
  } catch (const std::exception& error) {
    tell_failure(error.what());
  }
  return kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  prepare_process();
  const int exit_code = run_guarded(argc, argv);
  const Status printed = flush_standard_output();
  if (printed) return exit_code;
  tell_failure(printed.error().message.c_str());
  return exit_code == kWrongUsage ? kWrongUsage : kFailed;
}
