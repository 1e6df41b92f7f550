#pragma once

#include <sys/types.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"

namespace terrella {

/// A film that another process of the program renders. thread: one
class FilmJob {
 public:
  /// Starts `terrella render` with these arguments. It writes its messages to film.log in the folder, which exists.
  [[nodiscard]] static Result<std::unique_ptr<FilmJob>> start(const std::filesystem::path& folder,
                                                              std::vector<std::string> arguments);
  ~FilmJob();  ///< stops the process, if it still runs
  FilmJob(const FilmJob&) = delete;
  FilmJob& operator=(const FilmJob&) = delete;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] int percent() const;  ///< part that is done, in tenths of the film
  [[nodiscard]] bool has_ended() const;
  /// Waits for the end. The error is the last message of the process.
  [[nodiscard]] Status end();

 private:
  explicit FilmJob(std::filesystem::path folder) : folder_(std::move(folder)) {}
  [[nodiscard]] std::vector<std::string> messages() const;

  std::filesystem::path folder_;
  pid_t pid_ = 0;  ///< 0: has ended
};

}  // namespace terrella
