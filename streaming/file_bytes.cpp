#include "streaming/file_bytes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>

#include "streaming/descriptor.h"

namespace terrella {
namespace {

Descriptor open_file(const std::filesystem::path& path) {
  return Descriptor(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
}

FileError system_error(const std::filesystem::path& path, int code) {
  const bool missing = code == ENOENT || code == ENOTDIR;
  return {missing ? FileProblem::missing : FileProblem::unreadable,
          fmt::format("{}: {}", path.string(), std::strerror(code))};
}

using Bytes = Result<std::vector<std::byte>, FileError>;

/// Reads `size` bytes, or fewer if the file ends before.
Bytes read_bytes(const Descriptor& file, const std::filesystem::path& path, std::size_t size) {
  std::vector<std::byte> bytes(size);
  std::size_t filled = 0;
  while (filled < size) {
    const ssize_t got = read(file.number(), bytes.data() + filled, size - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return system_error(path, errno);
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  bytes.resize(filled);
  return bytes;
}

/// Size of a regular file.
Result<std::size_t, FileError> size_of(const Descriptor& file, const std::filesystem::path& path) {
  if (file.number() < 0) return system_error(path, errno);
  struct stat status {};
  if (fstat(file.number(), &status) != 0) return system_error(path, errno);
  // A pipe or device in place of a tile would block a worker forever.
  if (!S_ISREG(status.st_mode)) return FileError{FileProblem::unreadable, path.string() + ": not a regular file"};
  return static_cast<std::size_t>(status.st_size);
}

}  // namespace

Result<std::vector<std::byte>, FileError> read_file(const std::filesystem::path& path, std::size_t max_bytes) {
  const Descriptor file = open_file(path);
  const Result<std::size_t, FileError> size = size_of(file, path);
  if (!size) return size.error();
  if (*size > max_bytes) {
    return FileError{FileProblem::too_large,
                     fmt::format("{}: {} bytes, at most {} are read", path.string(), *size, max_bytes)};
  }
  return read_bytes(file, path, *size);
}

Result<std::vector<std::byte>, FileError> read_head(const std::filesystem::path& path, std::size_t max_bytes) {
  const Descriptor file = open_file(path);
  const Result<std::size_t, FileError> size = size_of(file, path);
  if (!size) return size.error();
  return read_bytes(file, path, std::min(*size, max_bytes));
}

std::size_t read_at(int descriptor, std::uint64_t offset, std::span<std::byte> into) {
  std::size_t done = 0;
  while (done < into.size()) {
    const ssize_t got = pread(descriptor, into.data() + done, into.size() - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return done;
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  errno = 0;
  return done;
}

std::string write_failure(int error_number) {
  if (error_number == 0) return "unknown reason";
  rlimit limit{};
  const bool limited = error_number == EFBIG && getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
  if (!limited) return std::strerror(error_number);
  return fmt::format("{}: a limit of {} bytes on the size of files is in force (ulimit -f)",
                     std::strerror(error_number), limit.rlim_cur);
}

std::string why_not_written(int error_number) {
  const char* advice = "; check that the folder exists and may be written to";
  if (error_number == ENOSPC || error_number == EDQUOT) advice = "; make room, or name an output on another disk";
  if (error_number == EFBIG) advice = "; raise the limit, or name an output on a file system that takes larger files";
  if (error_number == 0) advice = "";
  return write_failure(error_number) + advice;
}

Status check_regular(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (std::filesystem::is_directory(status)) {
    return Error{fmt::format("{}: is a folder, not a picture", path.string())};
  }
  if (!std::filesystem::is_other(status)) return Done{};
  return Error{fmt::format("{}: is a pipe, a device or a socket; save the picture as a file", path.string())};
}

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace terrella
