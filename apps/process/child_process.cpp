#include "apps/process/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace terrella {
namespace {

void add_file(posix_spawn_file_actions_t& files, int to, int from, int access) {
  if (from < 0) {
    posix_spawn_file_actions_addopen(&files, to, "/dev/null", access, 0);
  } else {
    posix_spawn_file_actions_adddup2(&files, from, to);
  }
}

}  // namespace

int start_child(const ChildProgram& child, pid_t& pid) {
  std::vector<std::string> words = child.words;
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
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
  const int refused = posix_spawnp(&pid, child.program.c_str(), &files, &how, arguments.data(), environ);
  posix_spawnattr_destroy(&how);
  posix_spawn_file_actions_destroy(&files);
  return refused;
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
