#include "streaming/cut/output/part_name.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>

#include "streaming/cut/output/tile_writer.h"

namespace terrella {

namespace fs = std::filesystem;

namespace {

/// Most times that the output may appear and vanish while its name is taken.
constexpr int kAttempts = 100;

int rename_by(const fs::path& from, const fs::path& to, unsigned flags) {
  return renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), flags);
}

/// For file systems that cannot exchange names, such as NFS. A folder cannot replace a non-empty folder, so the old one
/// is moved aside first.
Status take_name_in_steps(const fs::path& part, const fs::path& output, const MayReplace& may_replace) {
  std::error_code failed;
  const bool there = fs::exists(output, failed);
  if (there) {
    if (Status may = may_replace(output); !may) return may;
  }
  const fs::path aside = part.string() + ".old";
  const bool steps_aside = there && fs::is_directory(output, failed);
  if (steps_aside) fs::rename(output, aside, failed);
  if (!failed) fs::rename(part, output, failed);
  if (failed) {
    std::error_code ignored;
    if (steps_aside) fs::rename(aside, output, ignored);
    return cannot_write(output, failed.value());
  }
  if (steps_aside) fs::rename(aside, part, failed);
  return sync_to_disk(folder_of(output));
}

}  // namespace

fs::path folder_of(const fs::path& output) {
  const fs::path folder = output.parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

fs::path part_name(const fs::path& output) {
  static std::atomic<unsigned> calls{0};
  const fs::path name = output.filename().empty() ? output.parent_path().filename() : output.filename();
  const fs::path folder = output.filename().empty() ? folder_of(output.parent_path()) : folder_of(output);
  return folder / fmt::format(".{}.{}-{}.part", name.string(), getpid(), calls++);
}

Status sync_to_disk(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return cannot_write(path, errno);
  const int failed = fsync(file) == 0 ? 0 : errno;
  close(file);
  // Some file systems cannot sync a directory. This is no reason to discard a tile set.
  if (failed != 0 && failed != EINVAL) return cannot_write(path, failed);
  return Done{};
}

Status take_name(const fs::path& part, const fs::path& output, const MayReplace& may_replace) {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (rename_by(part, output, RENAME_NOREPLACE) == 0) return sync_to_disk(folder_of(output));
    if (errno == EINVAL) return take_name_in_steps(part, output, may_replace);
    if (errno != EEXIST) return cannot_write(output, errno);
    if (Status may = may_replace(output); !may) return may;
    if (rename_by(part, output, RENAME_EXCHANGE) != 0) {
      if (errno == ENOENT) continue;
      return errno == EINVAL ? take_name_in_steps(part, output, may_replace) : cannot_write(output, errno);
    }
    Status was = may_replace(part);
    if (was) return sync_to_disk(folder_of(output));
    if (rename_by(part, output, RENAME_EXCHANGE) != 0) return cannot_write(output, errno);
    return was;
  }
  return cannot_write(output, EBUSY);
}

}  // namespace terrella
