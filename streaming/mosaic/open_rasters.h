#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "streaming/mosaic/mosaic_sheet.h"
#include "streaming/warp/stored_blocks.h"

namespace terrella {

struct OpenRasterOptions {
  MosaicReading reading{};
  bool numbers = false;                 ///< blocks are numbers
  bool heights = false;                 ///< numbers are metres: units of length are converted
  int most_open = 32;                   ///< files that stay open; ≥ 1. A thread that reads may have one more open
  std::filesystem::path work_folder{};  ///< for decoded pictures without tiles (RasterOptions)
  std::function<void(int files)> left_out{};  ///< receives the number of such files. thread: any
  /// Receives the reason once for a file that cannot be read. thread: any, one at a time
  std::function<void(const std::string& reason)> remark{};
};

/// The files of a mosaic: each is opened when first needed; the least recently used is closed. thread: any
class OpenRasters {
 public:
  OpenRasters(const std::vector<PlacedFile>& files, OpenRasterOptions options);

  /// Decodes a block of a file: `block.level` is an index in MosaicFile::sizes. A file that cannot be read is named
  /// once (OpenRasterOptions::remark). The failure has no reason.
  [[nodiscard]] DecodedBlocks::Decoded block(int file, const TileId& block);
  /// The value of a pixel of a file (RasterSource::value_at()).
  [[nodiscard]] Result<double, TileFailure> value_at(int file, std::int64_t column, std::int64_t row);
  /// The shape of a file's level; none if the file cannot be opened.
  [[nodiscard]] std::optional<RasterLevel> level(int file, int level);
  /// Number of times that a file was opened.
  [[nodiscard]] int times_opened() const { return times_opened_; }
  /// Number of files that could not be read so far.
  [[nodiscard]] int unreadable() const { return unreadable_; }

 private:
  struct Open {
    int file = 0;
    std::shared_ptr<RasterSource> raster;
    std::size_t bytes = 0;  ///< memory that an open file may take
  };
  std::shared_ptr<RasterSource> open(int file);
  void close_oldest();
  void refuse(int file, const std::string& why);

  const std::vector<PlacedFile>& files_;
  const OpenRasterOptions options_;
  std::mutex mutex_;      ///< guards the members below
  std::list<Open> open_;  ///< most recently used first
  std::unordered_map<int, std::list<Open>::iterator> places_;
  std::unordered_set<int> named_;  ///< files that could not be read
  std::size_t bytes_ = 0;
  std::atomic<int> times_opened_ = 0;
  std::atomic<int> unreadable_ = 0;
  DecodedBlocks decoded_;  ///< TileId::level: file · 64 + level
};

}  // namespace terrella
