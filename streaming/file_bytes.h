#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"

namespace terrella {

enum class FileProblem { missing, too_large, unreadable };
struct FileError {
  FileProblem problem = FileProblem::unreadable;
  std::string message;  ///< names the path
};

/// The bytes of a regular file, at most `max_bytes`; a larger one is refused before it is read. thread: any
[[nodiscard]] Result<std::vector<std::byte>, FileError> read_file(const std::filesystem::path& path,
                                                                  std::size_t max_bytes);

/// The first bytes of a regular file, at most `max_bytes`. thread: any
[[nodiscard]] Result<std::vector<std::byte>, FileError> read_head(const std::filesystem::path& path,
                                                                  std::size_t max_bytes);

/// Why a write failed with this errno, and what to do: "No space left on device; make room, …". thread: any
[[nodiscard]] std::string why_not_written(int error_number);
/// The first part of it. Names the limit on the size of files that is in force if that is the reason. thread: any
[[nodiscard]] std::string write_failure(int error_number);

}  // namespace terrella
