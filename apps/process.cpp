#include "apps/process.h"

#include <fcntl.h>
#include <fmt/format.h>
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

#include "streaming/file_bytes.h"

namespace terrella {
namespace {

/// Cleaning up could need the memory that is not there, and other threads go on meanwhile: the process ends at once.
[[noreturn]] void end_now(const char* why) {
  tell_failure(why);
  _exit(1);
}

/// An exception that nothing catches, in any thread. Mistakes in the program still abort.
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

void open_standard_streams() {
  constexpr std::array kWrongWay{O_WRONLY, O_RDONLY, O_RDONLY};
  for (int stream = 0; stream < 3; ++stream) {
    // The lowest free number is the stream's own.
    if (fcntl(stream, F_GETFD) == -1 && errno == EBADF && open("/dev/null", kWrongWay[stream]) != stream) _exit(1);
  }
}

}  // namespace

void prepare_process() {
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

void tell_failure(const char* why) noexcept {
  for (const char* text : {"terrella: ", why, "\n"}) {
    // Nothing is left to do if this fails too.
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) return;
  }
}

}  // namespace terrella
