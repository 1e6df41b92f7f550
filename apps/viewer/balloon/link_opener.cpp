#include "apps/viewer/balloon/link_opener.h"

#include <sys/wait.h>

#include <algorithm>
#include <system_error>

#include "apps/process/child_process.h"
#include "apps/viewer/balloon/object_fields.h"

namespace terrella {
namespace {

std::string failure(const std::string& link, const std::string& why) { return "Cannot open " + link + ": " + why; }

}  // namespace

Status LinkOpener::open(const std::string& link) {
  if (!is_link(link)) return Error{failure(link, "not an address of http or https")};
  pid_t pid = 0;
  // A signal from the terminal does not end the browser. The input and output of the viewer stay its own.
  const ChildProgram browser{.program = "xdg-open", .words = {"xdg-open", link}, .own_session = true};
  if (const int refused = start_child(browser, pid); refused != 0) {
    return Error{failure(link, "xdg-open: " + std::generic_category().message(refused))};
  }
  running_.push_back({pid, link});
  return Done{};
}

bool LinkOpener::has_ended() const {
  return std::ranges::any_of(running_, [](const Running& one) { return has_child_ended(one.pid); });
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
