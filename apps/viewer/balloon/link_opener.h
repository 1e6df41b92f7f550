#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "base/result.h"

namespace terrella {

/// Opens links with the system's browser, by the program xdg-open and without a shell. The program may run for as long
/// as the browser, so nothing waits for it. thread: main
class LinkOpener {
 public:
  /// Starts the program. Fails if the text is no link (is_link()), or if there is no such program.
  [[nodiscard]] Status open(const std::string& link);
  /// True if a started program has ended and take_failures() has not seen this.
  [[nodiscard]] bool has_ended() const;
  /// Links that programs could not open since the last call, as messages.
  [[nodiscard]] std::vector<std::string> take_failures();

 private:
  struct Running {
    pid_t pid;
    std::string link;
  };
  std::vector<Running> running_;
};

}  // namespace terrella
