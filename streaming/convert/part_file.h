#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "base/result.h"
#include "streaming/byte_range.h"
#include "streaming/cache/sqlite_writer.h"

namespace terrella {

/// A new file for incomplete data. The destructor removes what has its name. Errors name the output. thread: one at a
/// time
class PartFile {
 public:
  PartFile(std::filesystem::path path, std::filesystem::path output)
      : path_(std::move(path)), output_(std::move(output)) {}
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// Opens the file, empty. May be called again to empty it.
  [[nodiscard]] Status open();
  [[nodiscard]] Status append(std::span<const std::byte> bytes);
  /// Appends bytes of another file.
  [[nodiscard]] Status append(const PartFile& from, ByteRange range);
  /// Replaces bytes that were appended.
  [[nodiscard]] Status write_at(std::uint64_t offset, std::span<const std::byte> bytes);
  /// Reads bytes that were appended.
  [[nodiscard]] Result<std::vector<std::byte>> read(const ByteRange& range) const;
  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  const std::filesystem::path path_;
  const std::filesystem::path output_;
  int file_ = -1;
  std::uint64_t size_ = 0;
};

/// "OUTPUT: cannot be written: …" with a cure if there is one. thread: any
[[nodiscard]] Error cannot_write(const std::filesystem::path& output, const WriteError& error);
[[nodiscard]] Status written(const std::filesystem::path& output, const WriteStatus& status);

}  // namespace terrella
