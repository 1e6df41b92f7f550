#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "base/result.h"

/// A task file is JSON that states what `cut` or `preload` does, so that the same work can be done again:
///
///     {"command": "preload", "SOURCE": "https://tiles.example/{z}/{x}/{y}.jpg", "output": "alps.gpkg",
///      "levels": "0-8", "bbox": [[5, 43, 17, 49], [5, 36, 19, 43]], "rate": 20}
///
/// A key is the long name of an option without its dashes, or the name of a positional argument as --help prints it. A
/// text or a number is the option's value, true gives an option without a value, and false leaves it out. A list of
/// numbers is one value with commas, and any other list gives the option several times. thread: main, for all of this
/// header
namespace terrella {

/// Adds --task to a subcommand.
void add_task_option(CLI::App& subcommand);

struct TaskError {
  std::string message;
  bool is_usage = false;  ///< a wrong command line or a wrong key; else a file that cannot be read
};

/// Replaces `--task FILE` by the arguments that the file states. An option among `arguments` replaces the task's, and
/// positional arguments replace those of the task. `arguments` begin with the subcommand. Without --task they return as
/// they are, also if the subcommand knows no --task. The error names the file and the key.
[[nodiscard]] Result<std::vector<std::string>, TaskError> with_task(const CLI::App& app,
                                                                    std::vector<std::string> arguments);

}  // namespace terrella
