#include "apps/viewer/flights/film_job.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <fstream>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "apps/process/child_process.h"
#include "apps/process/exit_code.h"
#include "apps/process/write_file.h"
#include "streaming/other_formats.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
constexpr const char* kLog = "film.log";

/// The number in "rendering film.mp4: 30 %", the report of the program's progress; nothing in another line.
std::optional<int> percent_in(const std::string& line) {
  constexpr std::string_view kUnit = " %";
  const std::size_t colon = line.rfind(": ");
  if (!line.starts_with("rendering ") || !line.ends_with(kUnit) || colon == std::string::npos) return std::nullopt;
  int percent = 0;
  const char* end = line.data() + line.size() - kUnit.size();
  const auto read = std::from_chars(line.data() + colon + 2, end, percent);
  return read.ec == std::errc() && read.ptr == end ? std::optional(percent) : std::nullopt;
}

}  // namespace

Result<std::unique_ptr<FilmJob>> FilmJob::start(const fs::path& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"terrella", "render"});
  const std::string log = (folder / kLog).string();
  std::string command;
  for (const std::string& argument : arguments) command += (command.empty() ? "" : " ") + shell_word(argument);
  command += "\n";
  if (Status written = write_file(log, std::as_bytes(std::span(command))); !written) return written.error();
  const int errors = ::open(log.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  std::unique_ptr<FilmJob> job(new FilmJob(folder));
  const int refused =
      errors < 0
          ? errno
          : start_child({.program = "/proc/self/exe", .words = std::move(arguments), .errors = errors}, job->pid_);
  if (errors >= 0) close(errors);
  if (refused == 0) return job;
  job->pid_ = 0;
  return Error{"No film can be started: " + std::generic_category().message(refused)};
}

FilmJob::~FilmJob() {
  if (pid_ == 0) return;
  stop();
  wait_for_child(pid_);
}

// A second signal would end the process in the middle of a frame.
void FilmJob::stop() {
  if (!std::exchange(stopped_, true)) kill(pid_, SIGTERM);
}

std::vector<std::string> FilmJob::messages() const {
  std::vector<std::string> lines;
  std::ifstream log(folder_ / kLog);
  for (std::string line; std::getline(log, line);) lines.push_back(line);
  return lines;
}

int FilmJob::percent() {
  std::error_code unknown;
  const std::uintmax_t bytes = fs::file_size(folder_ / kLog, unknown);
  if (unknown || std::exchange(read_bytes_, bytes) == bytes) return percent_;
  for (const std::string& line : messages()) percent_ = std::max(percent_, percent_in(line).value_or(0));
  return percent_;
}

bool FilmJob::has_ended() const { return has_child_ended(pid_); }

Result<std::string> FilmJob::end() {
  const int state = wait_for_child(std::exchange(pid_, 0));
  const std::string name = folder_.filename().string();
  if (WIFEXITED(state) && WEXITSTATUS(state) == kDone) return "The film is in " + name;
  if (stopped_) return fmt::format("Film cancelled; {}/{} has its command", name, kLog);
  if (WIFEXITED(state) && WEXITSTATUS(state) == kDoneInPart)
    return fmt::format("The film is in {}, but something is missing; {}/{} says what", name, name, kLog);
  std::vector<std::string> said = messages();
  std::erase_if(said, [](const std::string& line) { return line.empty() || percent_in(line); });
  return Error{fmt::format("No film is in {}: {}", name, said.size() < 2 ? "it ended without a message" : said.back())};
}

}  // namespace terrella
