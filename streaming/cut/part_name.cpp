#include "streaming/cut/part_name.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>

#include "streaming/cut/tile_writer.h"

namespace terrella {

namespace fs = std::filesystem;

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
  // Some file systems cannot sync a directory; that is no reason to throw a tile set away.
  if (failed != 0 && failed != EINVAL) return cannot_write(path, failed);
  return Done{};
}

Status take_name(const fs::path& part, const fs::path& output) {
  std::error_code failed;
  fs::rename(part, output, failed);
  if (failed) return cannot_write(output, failed.value());
  return sync_to_disk(folder_of(output));
}

}  // namespace terrella
