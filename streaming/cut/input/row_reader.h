#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "base/result.h"

namespace terrella {

/// The longest side that a picture to cut may have, pixels.
inline constexpr std::int64_t kMaxPictureSide_px = 1 << 20;
/// What a reader may hold of a picture that cannot be read row by row (progressive JPEG, interlaced PNG, a row of TIFF
/// tiles), bytes. A picture that needs more is refused, with advice.
inline constexpr std::uint64_t kMaxHeldBytes = 1ULL << 30;

struct PictureInfo {
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  bool has_alpha = false;  ///< if not, every alpha that is read is 255
};

/// A picture read from the top, one row at a time, as RGBA8, not premultiplied. Memory does not grow with the height.
/// 16-bit samples are scaled to 8. Hostile bytes are an error, never a crash.
/// thread: one at a time
class RowReader {
 public:
  virtual ~RowReader() = default;
  [[nodiscard]] virtual const PictureInfo& info() const = 0;
  /// Reads the next row into `rgba`, 4 · width bytes; called at most `height` times. The error names the file and the
  /// row. After an error no more rows can be read.
  [[nodiscard]] virtual Status read_row(std::span<std::uint8_t> rgba) = 0;
  /// Passes over `rows` rows, at most as many as are left. Readers that cannot jump decode them.
  [[nodiscard]] virtual Status skip_rows(std::int64_t rows);
};

/// The same rows, the last one repeated until there are `rows` of them.
[[nodiscard]] std::unique_ptr<RowReader> with_rows(std::unique_ptr<RowReader> reader, std::int64_t rows);

/// Refuses folders, and pipes, devices and sockets, which would keep their reader waiting. What is missing is left to
/// the reader.
[[nodiscard]] Status check_regular(const std::filesystem::path& path);

/// Opens a JPEG, PNG, TIFF or BigTIFF, known by its first bytes. The error names the file, what is wrong and what to
/// do.
[[nodiscard]] Result<std::unique_ptr<RowReader>> open_rows(const std::filesystem::path& path);

struct HeightCoding;
/// The same for heights: rows of 32-bit floats instead of RGBA8 (streaming/cut/input/heights.h), from a PNG of one
/// channel of 16 bits, or a TIFF of the coding's kind.
[[nodiscard]] Result<std::unique_ptr<RowReader>> open_height_rows(const std::filesystem::path& path,
                                                                  const HeightCoding& coding);

}  // namespace terrella
