#pragma once

#include <cstddef>
#include <string>

#include "base/result.h"

namespace terrella {

/// Prepares the process for what the system may do to it; call it first. A file-size limit makes writes fail instead of
/// ending the program (SIGXFSZ). Closed standard streams are opened, so that no file gets their number: input and
/// output fail as before, messages go nowhere. An allocation or a new thread that fails in any thread, where nothing
/// catches it, ends the program with a message and exit code 1. thread: main
void prepare_process();

/// Writes out what waits for standard output. The error says that it could not be written, now or earlier.
/// thread: main
[[nodiscard]] Status flush_standard_output();

/// Asks the system for so much memory, and gives it back. For what cannot bear that there is none, as OpenGL drivers,
/// which read through null pointers then. `what` begins the error. thread: any
[[nodiscard]] Status check_memory(std::size_t bytes, const std::string& what);

/// Prints "terrella: WHY" on standard error. Neither allocates nor throws. thread: any
void tell_failure(const char* why) noexcept;

inline constexpr const char* kOutOfMemory =
    "out of memory; do less at once (--memory, --jobs, --tile-size, --size), or raise the limit (ulimit -v)";
inline constexpr const char* kOutOfThreads =
    "the system starts no more threads; give fewer --jobs, or raise the limits (ulimit -u, ulimit -v)";

}  // namespace terrella
