#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace terrella::truth {

struct ProcessResult {
  int exit_code = -1;  ///< -1: it did not start, or a signal ended it
  double seconds = 0.0;
  std::string output;  ///< standard output and standard error, as they came
};

/// Runs a program to its end, without a shell. `scratch` is a file that the output passes through.
[[nodiscard]] ProcessResult run_process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                                        const std::filesystem::path& scratch);

}  // namespace terrella::truth
