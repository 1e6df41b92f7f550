#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/result.h"
#include "streaming/raster/tiff_picture.h"

namespace terrella {

/// Place of a tile's compressed bytes in the file; size 0: the file does not store the tile.
struct ByteSpan {
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
};

/// Looks up the bytes of a tile: one span for each plane, or for each strip of each plane. The error says why the table
/// of tiles cannot be used, but does not name the file. thread: that of the reader
[[nodiscard]] Result<std::vector<ByteSpan>> tile_spans(TiffReader& reader, const TiffPicture& picture,
                                                       std::int64_t column, std::int64_t row);

/// Decodes the first `rows` rows of a tile from its bytes, one piece for each span. Returns unpacked samples, those of
/// a pixel together. A tile that is not stored has the no-data value, or 0, in every sample. The reader's directory
/// must be the picture's. The error does not name the file. thread: that of the reader
[[nodiscard]] Result<std::vector<std::uint8_t>> decode_tile(TiffReader& reader, const TiffPicture& picture,
                                                            std::int64_t column, std::int64_t row,
                                                            std::vector<std::vector<std::byte>> pieces,
                                                            std::int64_t rows);

/// Decodes the part of a tile that has this span, from its bytes. No error for a span of another tile. The error does
/// not name the file. thread: that of the reader
[[nodiscard]] Status check_span(TiffReader& reader, const TiffPicture& picture, std::int64_t column, std::int64_t row,
                                const ByteSpan& span, std::span<const std::byte> bytes);

/// Reads a tile from the file and decodes its first `rows` rows. thread: any, several at once
[[nodiscard]] Result<std::vector<std::uint8_t>> read_tile(TiffReaders& readers, const TiffPicture& picture,
                                                          std::int64_t column, std::int64_t row, std::int64_t rows);

/// Unpacks the samples of `pixels` pixels of one plane and puts them among those of the other planes. `to` has
/// pixel_bytes() for each pixel. thread: any
void place_plane(const TiffPicture& picture, std::size_t plane, const std::uint8_t* packed, std::int64_t pixels,
                 std::uint8_t* to);

}  // namespace terrella
