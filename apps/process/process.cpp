#include "apps/process/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>
#include <system_error>

#include "apps/process/child_process.h"
#include "streaming/file_bytes.h"

namespace terrella {
namespace {

/// Ends the process at once. Cleaning up could need more memory, and other threads continue meanwhile.
[[noreturn]] void end_now(const char* why) {
  tell_failure(why);
  _exit(1);
}

/// Handles exceptions that no thread catches. Programming errors still abort.
[[noreturn]] void on_terminate() {
  if (std::current_exception()) {
    try {
      throw;
    } catch (const std::bad_alloc&) {
      end_now(kOutOfMemory);
    } catch (const std::system_error& error) {
      if (error.code() == std::errc::resource_unavailable_try_again) end_now(kOutOfThreads);
    } catch (...) {
    }
  }
  std::abort();
}

/// Opens closed streams: input and output fail as before, and messages are discarded.
void open_standard_streams() {
  constexpr std::array kModes{O_WRONLY, O_RDONLY, O_WRONLY};
  for (int stream = 0; stream < 3; ++stream) {
    // open() takes the lowest free number, which is the stream's own.
    if (fcntl(stream, F_GETFD) == -1 && errno == EBADF && open("/dev/null", kModes[stream]) != stream) _exit(1);
  }
}

}  // namespace

void prepare_process() {
  end_with_parent();
  open_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);
  std::set_terminate(on_terminate);
}

Status flush_standard_output() {
  std::cout.flush();
  const bool lost_before = std::ferror(stdout) != 0 || !std::cout;
  errno = 0;
  if (std::fflush(stdout) == 0 && !lost_before) return Done{};
  return Error{fmt::format("standard output cannot be written{}; what should stand there is lost",
                           errno != 0 ? ": " + write_failure(errno) : "")};
}

Status check_memory(std::size_t bytes, const std::string& what) {
  // Reserved address space counts against a limit but uses no memory.
  void* const room = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED) {
    return Error{fmt::format("{} needs {} MB of memory, which there are not; raise the limit (ulimit -v)", what,
                             bytes / 1'000'000)};
  }
  munmap(room, bytes);
  return Done{};
}

void tell_failure(const char* why) noexcept {
  for (const char* text : {"terrella: ", why, "\n"}) {
    // No remedy is left if this write fails too.
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) return;
  }
}

}  // namespace terrella
