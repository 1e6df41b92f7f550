#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "geo/result.h"

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

}  // namespace terrella
