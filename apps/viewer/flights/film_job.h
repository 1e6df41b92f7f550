#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/process/program_job.h"
#include "base/result.h"

namespace terrella {

/// A film that another process of the program renders. thread: one
class FilmJob {
 public:
  /// Starts `terrella render` with these arguments. film.log in the folder, which exists, gets the command and then its
  /// messages. The end of the job stops the process, if it still runs, which takes as long as a frame.
  [[nodiscard]] static Result<std::unique_ptr<FilmJob>> start(const std::filesystem::path& folder,
                                                              std::vector<std::string> arguments);

  [[nodiscard]] int percent();         ///< part that is done, 0 to 100 in steps of 10
  void stop() const { job_->stop(); }  ///< asks the process to end after its frame
  [[nodiscard]] bool is_stopped() const { return job_->is_stopped(); }
  [[nodiscard]] bool has_ended() const { return job_->has_ended(); }
  /// Waits for the end, and tells it as a message to the user. An error is the last message of the process.
  [[nodiscard]] Result<std::string> end();

 private:
  FilmJob(std::filesystem::path folder, std::unique_ptr<ProgramJob> job)
      : folder_(std::move(folder)), job_(std::move(job)) {}

  std::filesystem::path folder_;
  std::unique_ptr<ProgramJob> job_;
  int percent_ = 0;  ///< at the last news of the log
};

}  // namespace terrella
