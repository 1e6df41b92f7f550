#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/result.h"
#include "streaming/raster/tiff_pyramid.h"

namespace terrella {

/// Rows of a TIFF's samples from the top, unpacked, those of a pixel together. Strips are decoded row by row. A row of
/// tiles is decoded by several threads, and held as a whole or, if it is large, in parts. thread: one at a time
class TiffSampleRows {
 public:
  TiffSampleRows(TiffPart part, int jobs);

  [[nodiscard]] const TiffPicture& picture() const { return part_.picture; }
  /// Returns the row `y`, row_bytes() long, valid until the next call. Rows may be left out, but not repeated. The
  /// error names the file, the row and the damage.
  [[nodiscard]] Result<const std::uint8_t*> read(std::int64_t y);

 private:
  [[nodiscard]] Error row_error(std::int64_t y, const std::string& why) const;
  [[nodiscard]] Status open_strips();
  [[nodiscard]] Status decode_strip_row(std::int64_t y);
  [[nodiscard]] Status decode_plane_row(std::size_t plane, std::int64_t y);
  [[nodiscard]] Status decode_tiles(std::int64_t tile_top, std::int64_t first_row);

  TiffPart part_;
  int jobs_;
  TiffReaders readers_;
  std::vector<std::unique_ptr<TiffReader>> planes_;  ///< for strips: each plane's reader
  std::vector<std::uint8_t> packed_;                 ///< for strips: a row of a plane
  std::int64_t next_row_ = 0;                        ///< for strips: the row after the last one decoded
  std::int64_t held_first_ = -1;                     ///< first row that is held
  std::int64_t held_rows_ = 1;                       ///< rows held at a time
  std::vector<std::uint8_t> held_;
};

}  // namespace terrella
