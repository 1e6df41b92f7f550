#include "streaming/raster/tiff_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace terrella {
namespace {

/// A part of a tile that is encoded by itself: a plane, or a strip of a plane.
struct TilePart {
  std::uint32_t index = 0;  ///< in the file's table
  std::size_t plane = 0;
  std::int64_t first_row = 0;  ///< in the tile
  std::int64_t rows = 0;
};

std::vector<TilePart> parts_of(const TiffPicture& picture, std::int64_t column, std::int64_t row) {
  const std::int64_t height = picture.tile_height_px, strip = picture.rows_per_strip;
  const std::int64_t top = row * height, bottom = std::min(top + height, picture.height_px);
  const std::int64_t of_plane =
      picture.tiled ? picture.tile_columns() * picture.tile_rows() : (picture.height_px + strip - 1) / strip;
  std::vector<TilePart> parts;
  for (std::size_t plane = 0; plane < picture.planes(); ++plane) {
    const std::int64_t before = static_cast<std::int64_t>(plane) * of_plane;
    if (picture.tiled) {
      const std::int64_t index = before + row * picture.tile_columns() + column;
      parts.push_back({.index = static_cast<std::uint32_t>(index), .plane = plane, .first_row = 0, .rows = height});
      continue;
    }
    for (std::int64_t y = top; y < bottom; y += strip) {
      parts.push_back({.index = static_cast<std::uint32_t>(before + y / strip),
                       .plane = plane,
                       .first_row = y - top,
                       .rows = std::min(strip, picture.height_px - y)});
    }
  }
  return parts;
}

std::string why_not(const TiffReader& reader) {
  return reader.message().empty() ? "the data end too early" : reader.message();
}

/// No codec makes a tile much larger than its samples. A larger size in the file is damage.
std::uint64_t most_stored_bytes(const TiffPicture& picture, const TilePart& part) {
  const auto packed =
      static_cast<std::uint64_t>(picture.packed_bytes(picture.tile_width_px)) * static_cast<std::uint64_t>(part.rows);
  return 2 * packed + (1U << 20);
}

/// `bytes` may be changed.
Status decode_part(TiffReader& reader, const TilePart& part, std::span<std::byte> bytes, std::span<std::uint8_t> to) {
  reader.clear_message();
  const int done = TIFFReadFromUserBuffer(reader.get(), part.index, bytes.data(), static_cast<tmsize_t>(bytes.size()),
                                          to.data(), static_cast<tmsize_t>(to.size()));
  return done == 1 ? Status(Done{}) : Error{why_not(reader)};
}

}  // namespace

Status check_span(TiffReader& reader, const TiffPicture& picture, std::int64_t column, std::int64_t row,
                  const ByteSpan& span, std::span<const std::byte> bytes) {
  for (const TilePart& part : parts_of(picture, column, row)) {
    int failed = 0;
    if (TIFFGetStrileOffsetWithErr(reader.get(), part.index, &failed) != span.offset || failed != 0) continue;
    std::vector<std::byte> copy(bytes.begin(), bytes.end());
    std::vector<std::uint8_t> samples(static_cast<std::size_t>(part.rows) *
                                      picture.packed_bytes(picture.tile_width_px));
    return decode_part(reader, part, copy, samples);
  }
  return Done{};
}

Result<std::vector<ByteSpan>> tile_spans(TiffReader& reader, const TiffPicture& picture, std::int64_t column,
                                         std::int64_t row) {
  std::vector<ByteSpan> spans;
  for (const TilePart& part : parts_of(picture, column, row)) {
    int failed = 0;
    ByteSpan span;
    span.offset = TIFFGetStrileOffsetWithErr(reader.get(), part.index, &failed);
    if (failed == 0) span.size = TIFFGetStrileByteCountWithErr(reader.get(), part.index, &failed);
    if (failed != 0) return Error{"its table of tiles is damaged: " + why_not(reader)};
    const std::uint64_t end = reader.bytes().size();
    if (span.size > 0 && (span.offset > end || span.size > end - span.offset)) {
      return Error{
          fmt::format("its bytes {} to {} lie beyond the end of the file", span.offset, span.offset + span.size)};
    }
    if (span.size > most_stored_bytes(picture, part)) return Error{fmt::format("it cannot have {} bytes", span.size)};
    spans.push_back(span);
  }
  return spans;
}

void place_plane(const TiffPicture& picture, std::size_t plane, const std::uint8_t* packed, std::int64_t pixels,
                 std::uint8_t* to) {
  const TiffSamples& samples = picture.samples;
  const std::size_t count = static_cast<std::size_t>(pixels) * picture.plane_samples();
  const std::size_t bytes = sample_bytes(samples.type);
  std::vector<std::uint8_t> unpacked;
  if (samples.is_packed()) {
    unpacked.resize(count * bytes);
    unpack_row(samples, packed, count, unpacked.data());
    packed = unpacked.data();
  }
  if (!picture.separate) {
    std::memcpy(to, packed, count * bytes);
    return;
  }
  const std::size_t step = samples.pixel_bytes();
  to += plane * bytes;
  for (std::size_t i = 0; i < count; ++i) std::memcpy(to + i * step, packed + i * bytes, bytes);
}

Result<std::vector<std::uint8_t>> decode_tile(TiffReader& reader, const TiffPicture& picture, std::int64_t column,
                                              std::int64_t row, std::vector<std::vector<std::byte>> pieces,
                                              std::int64_t rows) {
  const std::int64_t width = picture.tile_width_px;
  const std::size_t row_bytes = picture.packed_bytes(width);
  const std::size_t to_row_bytes = static_cast<std::size_t>(width) * picture.samples.pixel_bytes();
  std::vector<std::uint8_t> samples(static_cast<std::size_t>(rows) * to_row_bytes);
  if (std::ranges::any_of(pieces, [](const auto& bytes) { return bytes.empty(); })) {
    fill_samples(picture.samples, picture.samples.nodata.value_or(0.0), static_cast<std::size_t>(rows * width),
                 samples.data());
  }
  const bool direct = !picture.separate && !picture.samples.is_packed();
  std::vector<std::uint8_t> packed(direct ? 0 : static_cast<std::size_t>(rows) * row_bytes);
  const std::vector<TilePart> parts = parts_of(picture, column, row);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::vector<std::byte>& bytes = pieces[i];
    const TilePart& part = parts[i];
    const std::int64_t wanted = std::min(part.rows, rows - part.first_row);
    if (bytes.empty() || wanted <= 0) continue;
    std::uint8_t* to = samples.data() + static_cast<std::size_t>(part.first_row) * to_row_bytes;
    const std::span<std::uint8_t> into(direct ? to : packed.data(), static_cast<std::size_t>(wanted) * row_bytes);
    if (Status decoded = decode_part(reader, part, bytes, into); !decoded) return decoded.error();
    for (std::int64_t y = 0; !direct && y < wanted; ++y) {
      place_plane(picture, part.plane, packed.data() + static_cast<std::size_t>(y) * row_bytes, width,
                  to + static_cast<std::size_t>(y) * to_row_bytes);
    }
  }
  return samples;
}

Result<std::vector<std::uint8_t>> read_tile(TiffReaders& readers, const TiffPicture& picture, std::int64_t column,
                                            std::int64_t row, std::int64_t rows) {
  auto reader = readers.lend();
  if (!reader) return reader.error();
  const auto spans = tile_spans(**reader, picture, column, row);
  if (!spans) {
    reader->drop();
    return spans.error();
  }
  std::vector<std::vector<std::byte>> pieces;
  for (const ByteSpan& span : *spans) {
    pieces.emplace_back(static_cast<std::size_t>(span.size));
    if (readers.bytes()->read_at(span.offset, pieces.back()) != pieces.back().size()) {
      return Error{"the file cannot be read to the tile's end"};
    }
  }
  return decode_tile(**reader, picture, column, row, std::move(pieces), rows);
}

}  // namespace terrella
