#pragma once

#include <memory>
#include <vector>

#include "streaming/raster/raster_pixels.h"

namespace terrella {

/// Rows of one level of a raster from the top, with its mask applied. Rows may be left out, but not repeated. A row of
/// tiles, or some strips, are decoded together by several threads. The error names the file and the row. thread: one at
/// a time
class RasterRows {
 public:
  /// `jobs`: threads; 0: one for each core.
  RasterRows(std::shared_ptr<const RasterFile> file, std::size_t level, PixelReading reading, int jobs);
  [[nodiscard]] const RasterShape& shape() const { return file_->header().levels[level_]; }
  [[nodiscard]] const PixelReading& reading() const { return reading_; }
  /// Converts the row `y` to RGBA8, 4 · width bytes.
  [[nodiscard]] Status colours(std::int64_t y, std::uint8_t* rgba);
  [[nodiscard]] Status numbers(std::int64_t y, float* numbers);

 private:
  [[nodiscard]] Status hold(std::int64_t y);
  [[nodiscard]] std::int64_t rows_from(std::int64_t y) const;

  const std::shared_ptr<const RasterFile> file_;
  const std::size_t level_;
  const PixelReading reading_;
  const int jobs_;
  std::int64_t held_from_ = 0;  ///< first row that is held
  std::int64_t held_rows_ = 0;
  std::vector<std::uint8_t> held_;   ///< samples of the held rows
  std::vector<std::uint8_t> shown_;  ///< their mask; empty without one
};

}  // namespace terrella
