#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <mutex>
#include <string>
#include <vector>

namespace terrella {

/// The messages of a call of the program's code, which it would have printed.
struct Said {
  int exit_code = 0;
  bool stopped = false;  ///< a signal came, as Ctrl-C
  std::string result;
  std::vector<std::string> messages;
};

/// Runs `work`, which returns an exit code, without Python's lock, one at a time in the process. Exceptions pass.
/// thread: that of Python
[[nodiscard]] Said run_long(const std::function<int()>& work);

/// Raises what the exit code means: terrella.Error for a failure, ValueError for wrong usage, KeyboardInterrupt after a
/// signal, each with the words of the program. Otherwise every message becomes a warning, a terrella.IncompleteWarning
/// if the work was done in part. thread: that of Python
void conclude(const Said& said);

/// Raises terrella.Error. thread: that of Python
[[noreturn]] void raise_error(const std::string& message);

/// Adds terrella.Error and terrella.IncompleteWarning. thread: that of Python
void add_exceptions(pybind11::module_& module);

}  // namespace terrella
