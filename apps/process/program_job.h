#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace terrella {

/// Another process of the program that does a subcommand. thread: one
class ProgramJob {
 public:
  /// Starts `terrella` with these arguments. `log` gets the command and then its messages, `result` its output; an
  /// empty path takes no output. `input` comes from memory, for secrets. The error is the reason alone.
  [[nodiscard]] static Result<std::unique_ptr<ProgramJob>> start(std::vector<std::string> arguments,
                                                                 const std::filesystem::path& log,
                                                                 const std::filesystem::path& result = {},
                                                                 std::string_view input = {});
  ~ProgramJob();  ///< stops the process, if it still runs, and waits for its end
  ProgramJob(const ProgramJob&) = delete;
  ProgramJob& operator=(const ProgramJob&) = delete;

  void stop();   ///< asks the process to end, once
  void abort();  ///< ends a process that leaves nothing half done
  [[nodiscard]] bool is_stopped() const { return stopped_; }
  [[nodiscard]] bool has_ended() const;
  /// Waits for the end. Returns the exit code, or the number of the signal that ended the process, below 0.
  [[nodiscard]] int exit_code();
  /// The lines of the log; the first is the command.
  [[nodiscard]] std::vector<std::string> messages() const;
  /// True if the log has grown since the last call.
  [[nodiscard]] bool has_news();

 private:
  explicit ProgramJob(std::filesystem::path log) : log_(std::move(log)) {}

  std::filesystem::path log_;
  pid_t pid_ = 0;  ///< 0: has ended
  bool stopped_ = false;
  std::uintmax_t read_bytes_ = 0;  ///< length of the log at the last has_news()
};

}  // namespace terrella
