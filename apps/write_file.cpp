#include "apps/write_file.h"

#include <unistd.h>

#include <fstream>
#include <string>

namespace terrella {
namespace {

namespace fs = std::filesystem;

bool write_all(const fs::path& path, std::span<const std::byte> bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  return static_cast<bool>(file);
}

}  // namespace

Status write_file(const fs::path& path, std::span<const std::byte> bytes) {
  const Error cannot{path.string() + ": cannot be written; check the folder, its rights and the free space"};
  std::error_code failed;
  const fs::file_status now = fs::status(path, failed);
  if (fs::is_directory(now)) return Error{path.string() + ": is a folder; name a file"};
  // A device's name must not be taken over by a file.
  if (fs::exists(now) && !fs::is_regular_file(now)) return write_all(path, bytes) ? Status(Done{}) : cannot;
  const fs::path part = path.string() + "." + std::to_string(getpid()) + ".part";
  if (write_all(part, bytes)) {
    fs::rename(part, path, failed);
    if (!failed) return Done{};
  }
  fs::remove(part, failed);
  return cannot;
}

}  // namespace terrella
