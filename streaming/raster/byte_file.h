#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "base/result.h"

namespace terrella {

/// The bytes of a file, read by position. A local file shares one descriptor among all threads. thread: any, several at
/// once
class ByteFile {
 public:
  virtual ~ByteFile() = default;
  [[nodiscard]] virtual const std::string& name() const = 0;  ///< for messages
  [[nodiscard]] virtual std::uint64_t size() const = 0;       ///< bytes
  /// Reads from `offset` on and returns the number of bytes read: fewer than `into` has at the end of the file, or if
  /// the file cannot be read.
  [[nodiscard]] virtual std::size_t read_at(std::uint64_t offset, std::span<std::byte> into) const = 0;
};

/// Opens a regular file. The error names the file and the cause. thread: any
[[nodiscard]] Result<std::shared_ptr<const ByteFile>> open_byte_file(const std::filesystem::path& path);

}  // namespace terrella
