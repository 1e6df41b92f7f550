#pragma once

#include <cstdint>

#include "base/result.h"
#include "streaming/raster/tiff_reader.h"
#include "streaming/raster/tiff_samples.h"

namespace terrella {

/// Most memory for a decoded tile or row, bytes. A file with larger ones is refused with advice.
inline constexpr std::uint64_t kMaxTiffTileBytes = 64ULL << 20;

/// One directory of a TIFF: size, blocks and samples, with all values checked against each other.
struct TiffPicture {
  std::uint64_t directory = 0;  ///< offset of the directory in the file, bytes
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  bool reduced = false;                   ///< a smaller version of another picture in the file
  bool mask = false;                      ///< transparency of another picture in the file
  int orientation = ORIENTATION_TOPLEFT;  ///< the Orientation tag: another value turns the stored rows
  bool tiled = false;
  bool separate = false;            ///< each sample has a plane of blocks of its own
  std::int64_t tile_width_px = 0;   ///< width of a tile, or of a block of strips (make_strip_blocks()); 0: strips alone
  std::int64_t tile_height_px = 0;  ///< likewise
  std::int64_t rows_per_strip = 1;  ///< at most height_px
  bool even_strips = false;         ///< the rows of a strip have packed_bytes()
  int compression = COMPRESSION_NONE;
  TiffSamples samples;

  [[nodiscard]] std::size_t planes() const { return separate ? samples.per_pixel : 1; }
  /// Samples of a pixel in one plane.
  [[nodiscard]] std::size_t plane_samples() const { return separate ? 1 : samples.per_pixel; }
  [[nodiscard]] std::size_t row_bytes() const { return static_cast<std::size_t>(width_px) * samples.pixel_bytes(); }
  [[nodiscard]] std::int64_t tile_columns() const { return (width_px + tile_width_px - 1) / tile_width_px; }
  [[nodiscard]] std::int64_t tile_rows() const { return (height_px + tile_height_px - 1) / tile_height_px; }
  /// True if parts of the picture can be read by themselves.
  [[nodiscard]] bool has_blocks() const { return tile_width_px > 0; }
  /// Bytes of `pixels` pixels of a row in one plane, as libtiff gives them.
  [[nodiscard]] std::size_t packed_bytes(std::int64_t pixels) const;
};

/// Reads the current directory. Samples of one colour plane may be numbers of any type; see TiffSamples. The error
/// names the file, the unsupported or contradictory value, and a cure. thread: that of the reader
[[nodiscard]] Result<TiffPicture> read_picture(TiffReader& reader);

/// Most memory for a block of strips, bytes.
inline constexpr std::uint64_t kMostStripBlockBytes = 4ULL << 20;

/// Lets a picture in strips be read like a tiled one: a block has whole strips, of 128 rows or more. False, and nothing
/// changes, if a decoded block would have more than kMostStripBlockBytes. thread: any
[[nodiscard]] bool make_strip_blocks(TiffPicture& picture);

/// "FILE: WHAT; save it as … (gdal_translate …)"
[[nodiscard]] Error refuse_tiff(const std::string& name, const std::string& what);

}  // namespace terrella
