#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
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
};

struct CloseLog {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using LogFile = std::unique_ptr<std::FILE, CloseLog>;

/// What a run keeps for the next one if it is killed: a file of records with checksums, one after the other, that has
/// its name only when it is whole and is called NAME.part before. In this machine's byte order. thread: one at a time
class RecordLogWriter : public TileWriter {
 public:
  /// Goes on after the last whole record of NAME.part if `resume`, else begins anew. `output` is named in errors.
  [[nodiscard]] static Result<std::unique_ptr<RecordLogWriter>> open(std::filesystem::path path, bool resume,
                                                                     std::filesystem::path output);
  /// Records that were there already.
  [[nodiscard]] std::int64_t found() const { return found_; }
  [[nodiscard]] Status put(const TileId& id, std::span<const std::byte> bytes) override;
  [[nodiscard]] Status finish() override;

 private:
  RecordLogWriter(std::filesystem::path path, std::filesystem::path output)
      : path_(std::move(path)), output_(std::move(output)) {}
  [[nodiscard]] Status write(std::span<const std::byte> bytes);

  std::filesystem::path path_, output_;
  LogFile file_;
  std::int64_t found_ = 0;
  std::int64_t records_ = 0;
};

/// Reads a whole log; what is damaged or ends too early is an error. thread: one at a time
class RecordLogReader {
 public:
  [[nodiscard]] static Result<RecordLogReader> open(const std::filesystem::path& path);
  /// The next record; none after the last.
  [[nodiscard]] Result<std::optional<LogRecord>> next();

 private:
  RecordLogReader(std::filesystem::path path, LogFile file) : path_(std::move(path)), file_(std::move(file)) {}
  std::filesystem::path path_;
  LogFile file_;
  std::int64_t records_ = 0;
};

}  // namespace terrella
