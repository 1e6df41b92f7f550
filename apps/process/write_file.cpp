#include "apps/process/write_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "streaming/file_bytes.h"
#include "streaming/raster/picture_kind.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Returns 0 or errno.
int write_all(const fs::path& path, std::span<const std::byte> bytes) {
  std::FILE* file = std::fopen(path.c_str(), "wbe");
  if (file == nullptr) return errno;
  errno = 0;
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const int failed = written ? 0 : errno;
  if (std::fclose(file) == 0) return failed;
  return failed != 0 ? failed : errno;
}

Error cannot_write_file(const fs::path& path, int error_number) {
  return Error{fmt::format("{}: cannot be written: {}", path.string(), why_not_written(error_number))};
}

/// True for the folder or file itself, and for files at any depth inside.
bool lies_in(const fs::path& file, const fs::path& folder) {
  std::error_code failed;
  const fs::path inner = fs::canonical(file, failed);
  const fs::path outer = failed ? fs::path() : fs::canonical(folder, failed);
  return !failed && std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

}  // namespace

Status may_write_picture(const fs::path& path, const std::vector<std::string>& inputs) {
  std::error_code failed;
  if (fs::is_directory(path, failed)) return Error{path.string() + ": is a folder; name a file"};
  if (!fs::is_regular_file(path, failed) || fs::file_size(path, failed) == 0) return Done{};
  for (const std::string& input : inputs) {
    if (input.empty() || !(fs::equivalent(path, input, failed) || lies_in(path, input))) continue;
    return Error{fmt::format("{}: belongs to {}, which is drawn from; name another output", path.string(), input)};
  }
  if (begins_as_picture(path)) return Done{};
  return Error{path.string() + ": is there already and is no picture; only pictures are replaced: name another output"};
}

Status write_file(const fs::path& path, std::span<const std::byte> bytes) {
  std::error_code failed;
  const fs::file_status now = fs::status(path, failed);
  if (fs::is_directory(now)) return Error{path.string() + ": is a folder; name a file"};
  // A file must not replace a device.
  if (fs::exists(now) && !fs::is_regular_file(now)) {
    const int error_number = write_all(path, bytes);
    return error_number == 0 ? Status(Done{}) : cannot_write_file(path, error_number);
  }
  const fs::path part = path.string() + "." + std::to_string(getpid()) + ".part";
  const int error_number = write_all(part, bytes);
  if (error_number == 0) {
    fs::rename(part, path, failed);
    if (!failed) return Done{};
  }
  const int why = error_number != 0 ? error_number : failed.value();
  fs::remove(part, failed);
  return cannot_write_file(path, why);
}

}  // namespace terrella
