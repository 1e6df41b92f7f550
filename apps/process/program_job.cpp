#include "apps/process/program_job.h"

#include <fcntl.h>
#include <sys/mman.h>  // memfd_create
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <span>
#include <system_error>
#include <utility>

#include "apps/process/child_process.h"
#include "apps/process/write_file.h"
#include "streaming/other_formats.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Opens a file for a child to append to; -1 with errno set.
int open_for_child(const fs::path& file) {
  constexpr int kReadable = 0644;
  return ::open(file.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, kReadable);
}

/// A file without a name that has a text; -1 with errno set.
int file_in_memory(std::string_view text) {
  const int file = memfd_create("terrella", MFD_CLOEXEC);
  while (file >= 0 && !text.empty()) {
    const ssize_t written = pwrite(file, text.data(), text.size(), lseek(file, 0, SEEK_END));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      close(file);
      return -1;
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return file;
}

}  // namespace

Result<std::unique_ptr<ProgramJob>> ProgramJob::start(std::vector<std::string> arguments, const fs::path& log,
                                                      const fs::path& result, std::string_view input) {
  arguments.insert(arguments.begin(), "terrella");
  std::string command;
  for (const std::string& argument : arguments) command += (command.empty() ? "" : " ") + shell_word(argument);
  command += "\n";
  if (Status written = write_file(log, std::as_bytes(std::span(command))); !written) return written.error();
  if (Status emptied = result.empty() ? Status(Done{}) : write_file(result, {}); !emptied) return emptied.error();
  const int errors = open_for_child(log), output = result.empty() ? -1 : open_for_child(result);
  std::unique_ptr<ProgramJob> job(new ProgramJob(log));
  const int text = input.empty() ? -1 : file_in_memory(input);
  const ChildProgram child{.program = "/proc/self/exe",
                           .words = std::move(arguments),
                           .input = text,
                           .output = output,
                           .errors = errors,
                           .ends_with_parent = true};
  const bool opened = errors >= 0 && (result.empty() || output >= 0) && (input.empty() || text >= 0);
  const int refused = opened ? start_child(child, job->pid_) : errno;
  for (const int file : {errors, output, text}) {
    if (file >= 0) close(file);
  }
  if (refused == 0) return job;
  job->pid_ = 0;
  return Error{std::generic_category().message(refused)};
}

ProgramJob::~ProgramJob() {
  if (pid_ == 0) return;
  stop();
  wait_for_child(pid_);
}

// A second signal would end the process in the middle of its work.
void ProgramJob::stop() {
  if (!std::exchange(stopped_, true)) kill(pid_, SIGTERM);
}

void ProgramJob::abort() {
  stopped_ = true;
  kill(pid_, SIGKILL);
}

bool ProgramJob::has_ended() const { return has_child_ended(pid_); }

int ProgramJob::exit_code() {
  const int state = wait_for_child(std::exchange(pid_, 0));
  return WIFEXITED(state) ? WEXITSTATUS(state) : -WTERMSIG(state);
}

std::vector<std::string> ProgramJob::messages() const {
  std::vector<std::string> lines;
  std::ifstream log(log_);
  for (std::string line; std::getline(log, line);) lines.push_back(line);
  return lines;
}

bool ProgramJob::has_news() {
  std::error_code unknown;
  const std::uintmax_t bytes = fs::file_size(log_, unknown);
  return !unknown && std::exchange(read_bytes_, bytes) != bytes;
}

}  // namespace terrella
