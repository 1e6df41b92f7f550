#include "streaming/raster/tiff_sample_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <optional>

#include "streaming/raster/in_parallel.h"
#include "streaming/raster/tiff_tiles.h"

namespace terrella {
namespace {

/// Most memory for a row of tiles, bytes. If a whole row needs more, only a part of its pixel rows is held at a time.
/// The tiles are then decoded again for each part, down to the part's last row. 86400 pixels of RGB with tiles of 256
/// rows fit.
constexpr std::uint64_t kTileRowBytes = 64ULL << 20;

}  // namespace

TiffSampleRows::TiffSampleRows(TiffPart part, int jobs)
    : part_(std::move(part)), jobs_(thread_count(jobs)), readers_(part_.file, part_.picture.directory) {
  const TiffPicture& picture = part_.picture;
  if (!picture.tiled) return;
  // Divides a row of tiles into as few parts of equal height as possible.
  const std::int64_t rows = std::min(picture.tile_height_px, picture.height_px);
  const auto fit = std::max<std::int64_t>(1, static_cast<std::int64_t>(kTileRowBytes / picture.row_bytes()));
  const std::int64_t parts = (rows + fit - 1) / fit;
  held_rows_ = (rows + parts - 1) / parts;
}

Error TiffSampleRows::row_error(std::int64_t y, const std::string& why) const {
  return Error{fmt::format("{}: row {} of {} cannot be read: {}; the file is truncated or damaged, get it again",
                           part_.file->name(), y + 1, part_.picture.height_px, why)};
}

Result<const std::uint8_t*> TiffSampleRows::read(std::int64_t y) {
  const TiffPicture& picture = part_.picture;
  held_.resize(picture.row_bytes() * static_cast<std::size_t>(held_rows_));
  if (!picture.tiled) {
    if (Status read = decode_strip_row(y); !read) return row_error(y, read.error().message);
    return static_cast<const std::uint8_t*>(held_.data());
  }
  const std::int64_t tile_top = y - y % picture.tile_height_px;
  const std::int64_t first = y - (y - tile_top) % held_rows_;
  if (first != held_first_) {
    if (Status read = decode_tiles(tile_top, first); !read) return row_error(y, read.error().message);
  }
  held_first_ = first;
  return static_cast<const std::uint8_t*>(held_.data() + static_cast<std::size_t>(y - first) * picture.row_bytes());
}

/// Each plane has its own reader, because a reader that changes planes decodes their strips again for each row.
Status TiffSampleRows::open_strips() {
  while (planes_.size() < part_.picture.planes()) {
    auto reader = readers_.open();
    if (!reader) return reader.error();
    planes_.push_back(*std::move(reader));
  }
  packed_.resize(static_cast<std::size_t>(TIFFScanlineSize(planes_.front()->get())));
  return Done{};
}

/// Most codecs cannot skip rows inside a strip, so the rows before are decoded too.
Status TiffSampleRows::decode_strip_row(std::int64_t y) {
  const TiffPicture& picture = part_.picture;
  if (planes_.empty()) {
    if (Status opened = open_strips(); !opened) return opened;
  }
  const std::int64_t strip = y - y % picture.rows_per_strip;
  for (std::int64_t row = std::max(next_row_, strip); row <= y; ++row) {
    for (std::size_t plane = 0; plane < planes_.size(); ++plane) {
      if (Status decoded = decode_plane_row(plane, row); !decoded) return decoded;
    }
  }
  next_row_ = y + 1;
  return Done{};
}

Status TiffSampleRows::decode_plane_row(std::size_t plane, std::int64_t y) {
  TiffReader& reader = *planes_[plane];
  const auto row = static_cast<std::uint32_t>(y);
  if (TIFFReadScanline(reader.get(), packed_.data(), row, static_cast<std::uint16_t>(plane)) != 1) {
    return Error{reader.message().empty() ? "the data end too early" : reader.message()};
  }
  place_plane(part_.picture, plane, packed_.data(), part_.picture.width_px, held_.data());
  return Done{};
}

/// Reads the rows held at a time, from `first_row` on, of the tiles at `tile_top`.
Status TiffSampleRows::decode_tiles(std::int64_t tile_top, std::int64_t first_row) {
  const TiffPicture& picture = part_.picture;
  const std::int64_t end = std::min({first_row + held_rows_, tile_top + picture.tile_height_px, picture.height_px});
  const auto above = static_cast<std::size_t>(first_row - tile_top);
  const std::size_t pixel_bytes = picture.samples.pixel_bytes();
  const std::size_t tile_row_bytes = static_cast<std::size_t>(picture.tile_width_px) * pixel_bytes;
  std::mutex mutex;
  std::optional<Error> failed;
  in_parallel(jobs_, picture.tile_columns(), [&](std::int64_t column) {
    const auto tile = read_tile(readers_, picture, column, tile_top / picture.tile_height_px, end - tile_top);
    if (!tile) {
      const std::lock_guard lock(mutex);
      if (!failed) failed = tile.error();
      return;
    }
    const std::int64_t x = column * picture.tile_width_px;
    const auto bytes = static_cast<std::size_t>(std::min(picture.tile_width_px, picture.width_px - x)) * pixel_bytes;
    for (std::size_t row = 0; row < static_cast<std::size_t>(end - first_row); ++row) {
      std::copy_n(tile->data() + (above + row) * tile_row_bytes, bytes,
                  held_.data() + row * picture.row_bytes() + static_cast<std::size_t>(x) * pixel_bytes);
    }
  });
  if (failed) return *failed;
  return Done{};
}

}  // namespace terrella
