#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "apps/process/process.h"
#include "apps/program/command_line.h"
#include "apps/program/commands.h"
#include "apps/program/task_file.h"

namespace {

using namespace terrella;

constexpr const char* kProgramExamples =
    "Examples:\n"
    "  terrella view                                  explore the Earth\n"
    "  terrella view moon.jpg --body moon             explore any planet from a 2:1 picture\n"
    "  terrella render -o shot.png --camera 46,7,3e5  save a picture, without display or GPU\n"
    "  terrella cut picture.tif -o planet.gpkg        cut a picture of any size into tiles";

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
  add_purge_command(app, exit_code);
  add_convert_command(app, exit_code);
  add_serve_command(app, exit_code);
  add_bench_command(app, exit_code);
  for (const char* command : {"cut", "preload", "purge"}) add_task_option(*app.get_subcommand(command));
  return run_command_line(app, std::vector<std::string>(argv + 1, argv + argc), exit_code);
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
