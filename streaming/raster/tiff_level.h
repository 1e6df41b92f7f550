#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "codecs/image.h"
#include "codecs/numbers.h"
#include "streaming/raster/tiff_pyramid.h"
#include "streaming/raster/tiff_sample_rows.h"
#include "streaming/raster/tiff_tiles.h"

namespace terrella {

/// Tiles of one level of a TIFF, with its mask applied. Picture and mask are tiled. Results have the size of a whole
/// tile. Errors do not name the file. thread: any, several at once
class TiffTileLevel {
 public:
  explicit TiffTileLevel(TiffLevel level);
  [[nodiscard]] const TiffPicture& picture() const { return level_.part.picture; }
  [[nodiscard]] Result<Image> colours(std::int64_t column, std::int64_t row, const ColourConverter& converter);
  [[nodiscard]] Result<Numbers> numbers(std::int64_t column, std::int64_t row, const NumberCoding& coding);
  /// exact_sample() of a pixel of the level; neither its mask nor its no-data value is looked at.
  [[nodiscard]] Result<double> exact_sample_at(std::int64_t x, std::int64_t y, std::size_t band);
  /// Looks up the bytes of the tile and of its mask. Parts that the file does not store are left out.
  [[nodiscard]] Result<std::vector<ByteSpan>> spans(std::int64_t column, std::int64_t row);
  /// Decodes one of spans() from its bytes.
  [[nodiscard]] Status check(std::int64_t column, std::int64_t row, const ByteSpan& span,
                             std::span<const std::byte> bytes);

 private:
  /// Calls `call` for each tile of the mask under the tile, with its column and row, until one fails.
  template <class Call>
  [[nodiscard]] Status for_each_mask_tile(std::int64_t column, std::int64_t row, const Call& call) const;
  /// Opacity of the tile's pixels; empty without a mask.
  [[nodiscard]] Result<std::vector<std::uint8_t>> opacity(std::int64_t column, std::int64_t row);
  [[nodiscard]] Result<std::vector<std::uint8_t>> samples(std::int64_t column, std::int64_t row);

  TiffLevel level_;
  TiffReaders readers_;
  std::unique_ptr<TiffReaders> mask_readers_;
};

/// Rows of one level of a TIFF from the top, with its mask applied. Rows may be left out, but not repeated. The error
/// names the file and the row. thread: one at a time
class TiffRowLevel {
 public:
  /// `jobs` threads decode a row of tiles; 0: one for each core.
  TiffRowLevel(TiffLevel level, int jobs);
  [[nodiscard]] const TiffPicture& picture() const { return rows_.picture(); }
  /// Converts the row `y` to RGBA8, 4 · width bytes.
  [[nodiscard]] Status colours(std::int64_t y, const ColourConverter& converter, std::uint8_t* rgba);
  [[nodiscard]] Status numbers(std::int64_t y, const NumberCoding& coding, float* numbers);

 private:
  [[nodiscard]] Result<const std::uint8_t*> opacity(std::int64_t y);

  TiffSampleRows rows_;
  std::unique_ptr<TiffSampleRows> mask_;
  std::vector<std::uint8_t> opacity_;
};

}  // namespace terrella
