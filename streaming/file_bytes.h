#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace terrella {

enum class FileProblem { missing, too_large, unreadable };
struct FileError {
  FileProblem problem = FileProblem::unreadable;
  std::string message;  ///< includes the path
};

/// Reads a regular file of at most `max_bytes`. Refuses a larger file before reading it. thread: any
[[nodiscard]] Result<std::vector<std::byte>, FileError> read_file(const std::filesystem::path& path,
                                                                  std::size_t max_bytes);

/// Reads at most the first `max_bytes` of a regular file. thread: any
[[nodiscard]] Result<std::vector<std::byte>, FileError> read_head(const std::filesystem::path& path,
                                                                  std::size_t max_bytes);

/// Reads from an open file. Returns the number of bytes: fewer than `into` has at the end of the file, or after an
/// error, which errno then names; errno is 0 otherwise. thread: any
[[nodiscard]] std::size_t read_at(int descriptor, std::uint64_t offset, std::span<std::byte> into);

/// Refuses folders, and also pipes, devices and sockets, because reading those may block. Accepts a missing file; the
/// reader then reports it.
[[nodiscard]] Status check_regular(const std::filesystem::path& path);

/// The ending of a file's name with its dot, in lower case: ".tif". thread: any
[[nodiscard]] std::string lower_extension(const std::filesystem::path& path);

/// Bytes as text. thread: any
[[nodiscard]] inline std::string_view as_text(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Explains why a write failed with this errno, and gives a cure: "No space left on device; make room, …". thread: any
[[nodiscard]] std::string why_not_written(int error_number);
/// The reason alone, without the cure. Names the limit on file size if that limit caused the failure. thread: any
[[nodiscard]] std::string write_failure(int error_number);

}  // namespace terrella
