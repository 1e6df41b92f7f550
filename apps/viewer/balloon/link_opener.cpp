#include "apps/viewer/balloon/link_opener.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <system_error>

#include "apps/viewer/balloon/object_fields.h"

namespace terrella {
namespace {

std::string failure(const std::string& link, const std::string& why) { return "Cannot open " + link + ": " + why; }

/// Starts xdg-open in a session of its own, so that a signal from the terminal does not end the browser. Returns the
/// number of the system's error, 0 for none. The input and output of the viewer stay its own.
int start(std::string link, pid_t& pid) {
  std::string program = "xdg-open";
  const std::array<char*, 3> arguments{program.data(), link.data(), nullptr};
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  for (const int out : {STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&files, out, "/dev/null", O_WRONLY, 0);
  }
  posix_spawnattr_t how;
  posix_spawnattr_init(&how);
  posix_spawnattr_setflags(&how, POSIX_SPAWN_SETSID);
  const int refused = posix_spawnp(&pid, program.c_str(), &files, &how, arguments.data(), environ);
  posix_spawnattr_destroy(&how);
  posix_spawn_file_actions_destroy(&files);
  return refused;
}

}  // namespace

Status LinkOpener::open(const std::string& link) {
  if (!is_link(link)) return Error{failure(link, "not an address of http or https")};
  pid_t pid = 0;
  if (const int refused = start(link, pid); refused != 0) {
    return Error{failure(link, "xdg-open: " + std::generic_category().message(refused))};
  }
  running_.push_back({pid, link});
  return Done{};
}

bool LinkOpener::has_ended() const {
  return std::ranges::any_of(running_, [](const Running& one) {
    siginfo_t ended{};
    return waitid(P_PID, static_cast<id_t>(one.pid), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 || ended.si_pid != 0;
  });
}

std::vector<std::string> LinkOpener::take_failures() {
  std::vector<std::string> failures;
  std::erase_if(running_, [&failures](const Running& one) {
    int status = 0;
    const pid_t ended = waitpid(one.pid, &status, WNOHANG);
    if (ended == 0) return false;
    if (ended == one.pid && status != 0) {
      const bool exited = WIFEXITED(status);
      failures.push_back(failure(one.link, exited ? "xdg-open ended with code " + std::to_string(WEXITSTATUS(status))
                                                  : "xdg-open was ended by a signal"));
    }
    return true;
  });
  return failures;
}

}  // namespace terrella
