#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace terrella {

/// A program to start beside this one, with its standard files. Numbers below 0 stand for /dev/null.
struct ChildProgram {
  std::string program;             ///< a path, or a name on PATH
  std::vector<std::string> words;  ///< its own name, then its arguments
  int input = -1, output = -1, errors = -1;
  bool own_session = false;       ///< a signal from the terminal does not reach it
  bool ends_with_parent = false;  ///< for this program itself, whose main() calls end_with_parent()
};

// thread: any, for all of these functions
/// Starts a program, which takes SIGPIPE as usual. Returns the number of the system's error, 0 for none.
[[nodiscard]] int start_child(const ChildProgram& child, pid_t& pid);
/// Lets SIGTERM end this process when the program ends that started it so, be it by a crash. thread: main, at first
void end_with_parent();
/// True if a child has ended; its state stays for wait_for_child().
[[nodiscard]] bool has_child_ended(pid_t pid);
/// Waits for the end of a child. Returns its state, as waitpid() has it.
int wait_for_child(pid_t pid);

}  // namespace terrella
