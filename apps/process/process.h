#pragma once

#include <cstddef>
#include <string>

#include "base/result.h"

namespace terrella {

/// Prepares the process for limits of the system; call this first. Writes beyond a file-size limit fail instead of
/// ending the program (SIGXFSZ). Closed standard streams are opened, so that no file gets their numbers; input and
/// output still fail, messages are lost. An uncaught failure to allocate or to start a thread ends the program with a
/// message and exit code 1. thread: main
void prepare_process();

/// Flushes standard output. Fails if any write, now or earlier, failed. thread: main
[[nodiscard]] Status flush_standard_output();

/// Allocates and frees this much memory as a test. Protects code that cannot handle failed allocations, such as OpenGL
/// drivers that dereference null pointers. The error begins with `what`. thread: any
[[nodiscard]] Status check_memory(std::size_t bytes, const std::string& what);

/// Prints "terrella: WHY" to standard error. Neither allocates nor throws. thread: any
void tell_failure(const char* why) noexcept;

inline constexpr const char* kOutOfMemory =
    "out of memory; do less at once (--memory, --jobs, --tile-size, --size), or raise the limit (ulimit -v)";
inline constexpr const char* kOutOfThreads =
    "the system starts no more threads; give fewer --jobs, or raise the limits (ulimit -u, ulimit -v)";

}  // namespace terrella
