#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "base/result.h"
#include "streaming/numbers/coding_options.h"

namespace terrella {

/// Longest side of a picture to cut, pixels.
inline constexpr std::int64_t kMaxPictureSide_px = 1 << 20;
/// Most memory for a picture that cannot be read row by row (progressive or turned JPEG, interlaced PNG, WebP, a row of
/// TIFF tiles), bytes. A picture that needs more is refused with advice.
inline constexpr std::uint64_t kMaxHeldBytes = 1ULL << 30;

struct PictureInfo {
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  bool has_alpha = false;      ///< false: all alpha values are 255
  bool opaque_inside = false;  ///< set with has_alpha if only the picture's outline is transparent
  int orientation = 1;         ///< EXIF orientation that the reader has applied, 1…8; 1: rows as stored
};

/// Reads a picture from the top, row by row, as RGBA8, not premultiplied. Memory does not grow with the height. 16-bit
/// samples are scaled to 8 bits. Hostile bytes cause an error, never a crash. thread: one at a time
class RowReader {
 public:
  virtual ~RowReader() = default;
  [[nodiscard]] virtual const PictureInfo& info() const = 0;
  /// Reads the next row into `rgba`, 4 · width bytes. Call at most `height` times. The error names the file and the
  /// row. After an error no more rows can be read.
  [[nodiscard]] virtual Status read_row(std::span<std::uint8_t> rgba) = 0;
  /// Skips `rows` rows, at most the number left. Readers that cannot seek decode the rows.
  [[nodiscard]] virtual Status skip_rows(std::int64_t rows);
};

/// A reader that finds each row by its number.
class SeekingRows : public RowReader {
 public:
  [[nodiscard]] Status skip_rows(std::int64_t rows) override {
    row_ += rows;
    return Done{};
  }

 protected:
  std::int64_t row_ = 0;  ///< the next row
};

/// Returns the same rows, with the last one repeated until there are `rows` rows.
[[nodiscard]] std::unique_ptr<RowReader> with_rows(std::unique_ptr<RowReader> reader, std::int64_t rows);

/// Opens a JPEG, PNG, WebP, TIFF or BigTIFF, identified by its first bytes. `choice` says how a TIFF is shown; other
/// pictures refuse a composite. `jobs` threads decode a row of a TIFF's tiles; 0: one for each core. The error names
/// the file, the fault and a cure.
[[nodiscard]] Result<std::unique_ptr<RowReader>> open_rows(const std::filesystem::path& path,
                                                           const CodingOptions& choice = {}, int jobs = 0);

struct HeightCoding;
/// Like open_rows(), for heights: rows of 32-bit floats instead of RGBA8 (streaming/cut/input/heights.h). Accepts a
/// one-channel 16-bit PNG, or a TIFF with samples of the coding's kind.
[[nodiscard]] Result<std::unique_ptr<RowReader>> open_height_rows(const std::filesystem::path& path,
                                                                  const HeightCoding& coding, int jobs = 0);

}  // namespace terrella
