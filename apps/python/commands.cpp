#include <pybind11/numpy.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <string>
#include <vector>

#include "apps/program/command_line.h"
#include "apps/program/commands.h"
#include "apps/python/arguments.h"
#include "apps/python/bindings.h"
#include "apps/python/long_call.h"

namespace terrella {
namespace {

namespace py = pybind11;

using AddCommand = void (*)(CLI::App&, int&);

/// The program with one subcommand.
struct Program {
  CLI::App app{"", "terrella"};
  int exit_code = kDone;
  explicit Program(AddCommand add) { add(app, exit_code); }
  [[nodiscard]] const CLI::App& command() const { return *app.get_subcommands({}).front(); }
};

/// Runs a subcommand. Returns its output for programs as Python's values.
py::object run_command(AddCommand add, const py::args& positional, const py::kwargs& keywords) {
  Program program(add);
  std::vector<std::string> words = command_arguments(program.command(), positional, keywords);
  words.insert(words.begin() + 1, "--json");
  const Said said = run_long([&] { return run_command_line(program.app, std::move(words), program.exit_code); });
  // A report of faults is a failed exit code of the program, but an answer here.
  const bool reported = said.exit_code == kFailed && said.messages.empty() && !said.result.empty();
  if (!reported) conclude(said);
  return py::module_::import("json").attr("loads")(said.result);
}

py::object render(const py::args& positional, const py::kwargs& keywords) {
  RenderCommand command;
  Image image;
  int exit_code = kDone;
  CLI::App app("", "terrella");
  CLI::App& sub = add_render_options(app, command);
  sub.callback([&] { exit_code = run_render(command, &image); });
  const Said said = run_long(
      [&, words = command_arguments(sub, positional, keywords)] { return run_command_line(app, words, exit_code); });
  conclude(said);
  return to_array(image);
}

/// A docstring that the module keeps for as long as it lives.
template <AddCommand kAdd>
void add_function(py::module_& module, const char* name) {
  const std::string doc = command_doc(name, Program(kAdd).command(), {"json"});
  module.def(
      name,
      [](const py::args& positional, const py::kwargs& keywords) { return run_command(kAdd, positional, keywords); },
      doc.c_str());
}

}  // namespace

py::object to_array(const Image& image) {
  constexpr py::ssize_t kChannels = 3;
  py::array_t<std::uint8_t> pixels(
      {static_cast<py::ssize_t>(image.height_px), static_cast<py::ssize_t>(image.width_px), kChannels});
  std::uint8_t* to = pixels.mutable_data();
  for (std::size_t from = 0; from < image.rgba.size(); from += 4) to = std::copy_n(&image.rgba[from], kChannels, to);
  return pixels;
}

void add_commands(py::module_& module) {
  RenderCommand command;
  CLI::App app;
  const std::string doc = command_doc("render", add_render_options(app, command), {"json"}) +
                          "\nReturns:\n    The picture, height x width x 3 bytes; rows from the top.\n";
  module.def("render", &render, doc.c_str());
  add_function<&add_film_command>(module, "film");
  add_function<&add_cut_command>(module, "cut");
  add_function<&add_preload_command>(module, "preload");
  add_function<&add_info_command>(module, "info");
  add_function<&add_merge_command>(module, "merge");
  add_function<&add_convert_command>(module, "convert");
  add_function<&add_purge_command>(module, "purge");
}

}  // namespace terrella
