#pragma once

#include <CLI/App.hpp>
#include <string>

#include "apps/process/exit_code.h"
#include "apps/program/scene_picture.h"
#include "codecs/image.h"

namespace terrella {

/// Adds a subcommand to the program. A named subcommand runs at the end of the parse and stores its exit code in
/// `exit_code`, which must outlive the parse. Throws CLI::ParseError on a wrong command line. thread: main
void add_bench_command(CLI::App& app, int& exit_code);
void add_convert_command(CLI::App& app, int& exit_code);
void add_cut_command(CLI::App& app, int& exit_code);
void add_info_command(CLI::App& app, int& exit_code);
void add_merge_command(CLI::App& app, int& exit_code);
void add_preload_command(CLI::App& app, int& exit_code);
void add_purge_command(CLI::App& app, int& exit_code);
void add_render_command(CLI::App& app, int& exit_code);
void add_serve_command(CLI::App& app, int& exit_code);
void add_view_command(CLI::App& app, int& exit_code);

/// The subcommand `render`, which takes --flight here and always renders a film.
void add_film_command(CLI::App& app, int& exit_code);

/// The subcommand `render` without a callback; `command` must outlive the parse. Returns the subcommand. thread: main
CLI::App& add_render_options(CLI::App& app, RenderCommand& command);
/// Draws the picture, writes it if the command names a file, reports as the program does and returns the exit code. Not
/// null, `image` gets the picture. thread: main
int run_render(const RenderCommand& command, Image* image);

/// Prints whose data an output shows; nothing for an empty text.
void thank(const std::string& output, const std::string& attributions);
/// Prints to standard error why a subcommand failed. Returns kFailed.
int fail(const char* command, const std::string& why);

}  // namespace terrella
