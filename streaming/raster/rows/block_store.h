#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "base/result.h"

namespace terrella {

/// Most memory for the pixels of one BlockStore, bytes. A larger picture is kept in a temporary file.
inline constexpr std::uint64_t kMaxStoredBytes = 128ULL << 20;

/// Size and kind of the pixels in a BlockStore.
struct StoredPixels {
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  std::size_t pixel_bytes = 4;  ///< 3: opaque colours; 4: RGBA8 or a float
};

/// Random access to a picture that can only be read row by row from the top (striped TIFF, JPEG, PNG). Reads rows when
/// a block is asked for, down to the block's last row, and keeps their pixels in blocks: in memory up to
/// kMaxStoredBytes, else in an uncompressed temporary file that has no name and vanishes with the store.
/// thread: any, several at once
class BlockStore {
 public:
  /// Writes the next row, 4 bytes for each pixel. The error names the picture.
  using NextRow = std::function<Status(std::span<std::uint8_t>)>;

  /// Creates the temporary file in `folder` when the first row is read.
  BlockStore(const StoredPixels& pixels, std::filesystem::path folder, NextRow next_row);
  ~BlockStore();
  BlockStore(const BlockStore&) = delete;
  BlockStore& operator=(const BlockStore&) = delete;

  [[nodiscard]] int block_width_px() const { return kBlockWidth_px; }
  [[nodiscard]] int block_height_px() const { return static_cast<int>(block_height_px_); }
  /// Returns the pixels of a whole block, 4 bytes each; those beyond the picture are 0.
  [[nodiscard]] Result<std::vector<std::uint8_t>> read(std::int64_t column, std::int64_t row);

 private:
  static constexpr int kBlockWidth_px = 256;

  [[nodiscard]] std::int64_t columns() const { return (pixels_.width_px + kBlockWidth_px - 1) / kBlockWidth_px; }
  [[nodiscard]] std::int64_t bands() const { return (pixels_.height_px + block_height_px_ - 1) / block_height_px_; }
  [[nodiscard]] std::size_t block_bytes() const;
  [[nodiscard]] Status open_file();
  [[nodiscard]] Status fill_to(std::int64_t row);
  [[nodiscard]] Status fill_band(std::int64_t row);
  [[nodiscard]] Status write_band(std::int64_t row);
  [[nodiscard]] bool in_memory() const;

  StoredPixels pixels_;
  std::filesystem::path folder_;
  NextRow next_row_;
  std::int64_t block_height_px_;
  std::mutex mutex_;
  std::atomic<std::int64_t> filled_{0};               ///< rows of blocks that can be read
  std::optional<Error> failed_;                       ///< the error that ended the filling
  std::vector<std::vector<std::uint8_t>> in_memory_;  ///< a row of blocks each
  std::vector<std::uint8_t> band_;                    ///< the row of blocks that is being filled
  int file_ = -1;
};

}  // namespace terrella
