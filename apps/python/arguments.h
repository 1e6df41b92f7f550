#pragma once

#include <pybind11/pybind11.h>

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace terrella {

/// The docstring of a function that takes the options of a subcommand as keywords: --surface-alpha is surface_alpha.
/// Its first lines are the signature, as inspect.signature() reads it. `left_out` are options that are no keywords.
/// thread: that of Python
[[nodiscard]] std::string command_doc(const std::string& function, const CLI::App& command,
                                      const std::vector<std::string>& left_out);

/// Writes a call as words of a command line, without the program's name. None and False leave an option out, True sets
/// a flag, a tuple becomes one value ("46,7,3e6", "640x480"), and a list repeats the option. Raises TypeError for
/// values that no option takes. thread: that of Python
[[nodiscard]] std::vector<std::string> command_arguments(const CLI::App& command, const pybind11::args& positional,
                                                         const pybind11::kwargs& keywords);

}  // namespace terrella
