#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"

namespace terrella {

/// A film that another process of the program renders. thread: one
class FilmJob {
 public:
  /// Starts `terrella render` with these arguments. film.log in the folder, which exists, gets the command and then its
  /// messages.
  [[nodiscard]] static Result<std::unique_ptr<FilmJob>> start(const std::filesystem::path& folder,
                                                              std::vector<std::string> arguments);
  ~FilmJob();  ///< stops the process, if it still runs, which takes as long as a frame
  FilmJob(const FilmJob&) = delete;
  FilmJob& operator=(const FilmJob&) = delete;

  [[nodiscard]] int percent();  ///< part that is done, 0 to 100 in steps of 10
  void stop();                  ///< asks the process to end after its frame
  [[nodiscard]] bool is_stopped() const { return stopped_; }
  [[nodiscard]] bool has_ended() const;
  /// Waits for the end, and tells it as a message to the user. An error is the last message of the process.
  [[nodiscard]] Result<std::string> end();

 private:
  explicit FilmJob(std::filesystem::path folder) : folder_(std::move(folder)) {}
  [[nodiscard]] std::vector<std::string> messages() const;

  std::filesystem::path folder_;
  pid_t pid_ = 0;  ///< 0: has ended
  bool stopped_ = false;
  std::uintmax_t read_bytes_ = 0;  ///< length of film.log when it was read last
  int percent_ = 0;                ///< percent() then
};

}  // namespace terrella
