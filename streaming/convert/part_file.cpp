#include "streaming/convert/part_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "streaming/cut/output/tile_writer.h"
#include "streaming/file_bytes.h"

namespace terrella {

PartFile::~PartFile() {
  if (file_ >= 0) close(file_);
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

Status PartFile::open() {
  if (file_ >= 0) close(file_);
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  size_ = 0;
  if (file_ < 0) return cannot_write(output_, errno);
  return Done{};
}

Status PartFile::append(std::span<const std::byte> bytes) {
  if (Status put = write_at(size_, bytes); !put) return put;
  size_ += bytes.size();
  return Done{};
}

Status PartFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t more = pwrite(file_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) return cannot_write(output_, more == 0 ? ENOSPC : errno);
    bytes = bytes.subspan(static_cast<std::size_t>(more));
    offset += static_cast<std::uint64_t>(more);
  }
  return Done{};
}

Status PartFile::append(const PartFile& from, ByteRange range) {
  constexpr std::uint64_t kPiece = 1U << 20;
  while (range.length > 0) {
    const std::uint64_t piece = std::min(range.length, kPiece);
    const auto bytes = from.read({.offset = range.offset, .length = piece});
    if (!bytes) return bytes.error();
    if (Status appended = append(*bytes); !appended) return appended;
    range = {.offset = range.offset + piece, .length = range.length - piece};
  }
  return Done{};
}

Result<std::vector<std::byte>> PartFile::read(const ByteRange& range) const {
  std::vector<std::byte> bytes(range.length);
  if (read_at(file_, range.offset, bytes) < bytes.size()) return cannot_write(output_, errno != 0 ? errno : EIO);
  return bytes;
}

Error cannot_write(const std::filesystem::path& output, const WriteError& error) {
  const char* cure = error.problem == WriteProblem::full ? "; make room, or name an output on another disk" : "";
  return Error{fmt::format("{}: cannot be written: {}{}", output.string(), error.message, cure)};
}

Status written(const std::filesystem::path& output, const WriteStatus& status) {
  if (!status) return cannot_write(output, status.error());
  return Done{};
}

}  // namespace terrella
