#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/result.h"
#include "streaming/cut/output/tile_writer.h"
#include "tiles/tile_grid.h"

namespace terrella {

struct LogRecord {
  TileId id;
  std::vector<std::byte> bytes;
  std::uint64_t offset = 0;  ///< offset of the bytes in the file
};

struct CloseLog {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using LogFile = std::unique_ptr<std::FILE, CloseLog>;

/// Records that a killed run leaves for the next run: a file of records with checksums, one after the other. The file
/// is called NAME.part until it is complete. It uses this machine's byte order. thread: one at a time
class RecordLogWriter : public TileWriter {
 public:
  /// Opens the log for writing. With `resume`, continues after the last complete record of NAME.part; else starts anew.
  /// `output` is named in errors.
  /// `told` may be empty. It receives every record, those found on opening too, as soon as another reader of the file
  /// finds it.
  using Told = std::function<void(const TileId& id, std::uint64_t offset, std::size_t size)>;
  [[nodiscard]] static Result<std::unique_ptr<RecordLogWriter>> open(std::filesystem::path path, bool resume,
                                                                     std::filesystem::path output, Told told = {});
  /// Number of records found on opening.
  [[nodiscard]] std::int64_t found() const { return found_; }
  [[nodiscard]] Status put(const TileId& id, std::span<const std::byte> bytes) override;
  [[nodiscard]] Status finish() override;

 private:
  RecordLogWriter(std::filesystem::path path, std::filesystem::path output, Told told)
      : path_(std::move(path)), output_(std::move(output)), told_(std::move(told)) {}
  [[nodiscard]] Status write(std::span<const std::byte> bytes);

  std::filesystem::path path_, output_;
  Told told_;
  LogFile file_;
  std::uint64_t end_ = 0;  ///< end of the file, bytes
  std::int64_t found_ = 0;
  std::int64_t records_ = 0;
};

/// Reads a whole log. Damaged or truncated logs cause an error. thread: one at a time
class RecordLogReader {
 public:
  [[nodiscard]] static Result<RecordLogReader> open(const std::filesystem::path& path);
  /// Returns the next record; none after the last.
  [[nodiscard]] Result<std::optional<LogRecord>> next();

 private:
  RecordLogReader(std::filesystem::path path, LogFile file) : path_(std::move(path)), file_(std::move(file)) {}
  std::filesystem::path path_;
  LogFile file_;
  std::uint64_t position_ = 0;
  std::int64_t records_ = 0;
};

}  // namespace terrella
