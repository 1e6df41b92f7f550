#include "apps/process/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>

namespace terrella {
namespace {

void add_file(posix_spawn_file_actions_t& files, int to, int from, int access) {
  if (from < 0) {
    posix_spawn_file_actions_addopen(&files, to, "/dev/null", access, 0);
  } else {
    posix_spawn_file_actions_adddup2(&files, from, to);
  }
}

/// Names the process whose end ends this one, too.
constexpr const char* kParentVariable = "TERRELLA_PARENT";

}  // namespace

int start_child(const ChildProgram& child, pid_t& pid) {
  std::vector<std::string> words = child.words;
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::string parent = std::string(kParentVariable) + "=" + std::to_string(getpid());
  std::vector<char*> variables;
  for (char** variable = environ; child.ends_with_parent && *variable != nullptr; ++variable) {
    variables.push_back(*variable);
  }
  variables.insert(variables.end(), {parent.data(), nullptr});
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  add_file(files, STDIN_FILENO, child.input, O_RDONLY);
  add_file(files, STDOUT_FILENO, child.output, O_WRONLY);
  add_file(files, STDERR_FILENO, child.errors, O_WRONLY);
  posix_spawnattr_t how;
  posix_spawnattr_init(&how);
  sigset_t usual;
  sigemptyset(&usual);
  sigaddset(&usual, SIGPIPE);
  posix_spawnattr_setsigdefault(&how, &usual);
  const unsigned session = child.own_session ? POSIX_SPAWN_SETSID : 0;
  posix_spawnattr_setflags(&how, static_cast<short>(POSIX_SPAWN_SETSIGDEF | session));
  const int refused = posix_spawnp(&pid, child.program.c_str(), &files, &how, arguments.data(),
                                   child.ends_with_parent ? variables.data() : environ);
  posix_spawnattr_destroy(&how);
  posix_spawn_file_actions_destroy(&files);
  return refused;
}

void end_with_parent() {
  const char* parent = std::getenv(kParentVariable);
  if (parent != nullptr && parent == std::to_string(getppid())) prctl(PR_SET_PDEATHSIG, SIGTERM);
  unsetenv(kParentVariable);
}

bool has_child_ended(pid_t pid) {
  siginfo_t ended{};
  return waitid(P_PID, static_cast<id_t>(pid), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 || ended.si_pid != 0;
}

int wait_for_child(pid_t pid) {
  int state = 0;
  while (waitpid(pid, &state, 0) < 0 && errno == EINTR) {
  }
  return state;
}

}  // namespace terrella
