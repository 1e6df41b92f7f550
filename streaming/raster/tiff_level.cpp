#include "streaming/raster/tiff_level.h"

#include <algorithm>
#include <iterator>
#include <limits>

namespace terrella {
namespace {

/// Converts samples of a mask to 0 for transparent … 255 for opaque.
void mask_to_opacity(const TiffSamples& samples, const std::uint8_t* from, std::size_t pixels, std::uint8_t* to) {
  const int most = (1 << samples.stored_bits) - 1;
  for (std::size_t i = 0; i < pixels; ++i) to[i] = static_cast<std::uint8_t>(from[i] * 255 / most);
}

void clear_colours(const std::uint8_t* opacity, std::size_t pixels, std::uint8_t* rgba) {
  for (std::size_t i = 0; i < pixels; ++i) {
    rgba[4 * i + 3] = static_cast<std::uint8_t>((rgba[4 * i + 3] * opacity[i] + 127) / 255);
  }
}

void clear_numbers(const std::uint8_t* opacity, std::size_t pixels, float* numbers) {
  for (std::size_t i = 0; i < pixels; ++i) {
    if (opacity[i] < 128) numbers[i] = std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace

TiffTileLevel::TiffTileLevel(TiffLevel level)
    : level_(std::move(level)), readers_(level_.part.file, level_.part.picture.directory) {
  if (!level_.mask) return;
  mask_readers_ = std::make_unique<TiffReaders>(level_.mask->file, level_.mask->picture.directory);
}

Result<std::vector<std::uint8_t>> TiffTileLevel::samples(std::int64_t column, std::int64_t row) {
  return read_tile(readers_, picture(), column, row, picture().tile_height_px);
}

/// The tiles of a mask may have another size than those of the picture.
template <class Call>
Status TiffTileLevel::for_each_mask_tile(std::int64_t column, std::int64_t row, const Call& call) const {
  if (!level_.mask) return Done{};
  const TiffPicture& mask = level_.mask->picture;
  const std::int64_t x0 = column * picture().tile_width_px;
  const std::int64_t y0 = row * picture().tile_height_px;
  const std::int64_t x1 = std::min(x0 + picture().tile_width_px, mask.width_px);
  const std::int64_t y1 = std::min(y0 + picture().tile_height_px, mask.height_px);
  for (std::int64_t v = y0 / mask.tile_height_px; v * mask.tile_height_px < y1; ++v) {
    for (std::int64_t u = x0 / mask.tile_width_px; u * mask.tile_width_px < x1; ++u) {
      if (Status done = call(u, v); !done) return done;
    }
  }
  return Done{};
}

Result<std::vector<std::uint8_t>> TiffTileLevel::opacity(std::int64_t column, std::int64_t row) {
  std::vector<std::uint8_t> all;
  if (!level_.mask) return all;
  const TiffPicture& mask = level_.mask->picture;
  const std::int64_t width = picture().tile_width_px, height = picture().tile_height_px;
  const std::int64_t x0 = column * width, y0 = row * height;
  all.resize(static_cast<std::size_t>(width * height));
  const Status read = for_each_mask_tile(column, row, [&](std::int64_t u, std::int64_t v) -> Status {
    const auto tile = read_tile(*mask_readers_, mask, u, v, mask.tile_height_px);
    if (!tile) return tile.error();
    const std::int64_t left = std::max(x0, u * mask.tile_width_px);
    const std::int64_t right = std::min({x0 + width, mask.width_px, (u + 1) * mask.tile_width_px});
    const std::int64_t bottom = std::min({y0 + height, mask.height_px, (v + 1) * mask.tile_height_px});
    for (std::int64_t y = std::max(y0, v * mask.tile_height_px); y < bottom; ++y) {
      const std::int64_t from = (y - v * mask.tile_height_px) * mask.tile_width_px + left - u * mask.tile_width_px;
      mask_to_opacity(mask.samples, tile->data() + from, static_cast<std::size_t>(right - left),
                      all.data() + (y - y0) * width + left - x0);
    }
    return Done{};
  });
  if (!read) return read.error();
  return all;
}

Result<std::vector<ByteSpan>> TiffTileLevel::spans(std::int64_t column, std::int64_t row) {
  std::vector<ByteSpan> all;
  const auto add = [&all](TiffReaders& readers, const TiffPicture& of, std::int64_t u, std::int64_t v) -> Status {
    auto reader = readers.lend();
    if (!reader) return reader.error();
    const auto found = tile_spans(**reader, of, u, v);
    if (!found) {
      reader->drop();
      return found.error();
    }
    std::ranges::copy_if(*found, std::back_inserter(all), [](const ByteSpan& span) { return span.size > 0; });
    return Done{};
  };
  if (Status found = add(readers_, picture(), column, row); !found) return found.error();
  const Status found = for_each_mask_tile(
      column, row, [&](std::int64_t u, std::int64_t v) { return add(*mask_readers_, level_.mask->picture, u, v); });
  if (!found) return found.error();
  return all;
}

Status TiffTileLevel::check(std::int64_t column, std::int64_t row, const ByteSpan& span,
                            std::span<const std::byte> bytes) {
  const auto check_in = [&](TiffReaders& readers, const TiffPicture& of, std::int64_t u, std::int64_t v) -> Status {
    auto reader = readers.lend();
    return reader ? check_span(**reader, of, u, v, span, bytes) : Status(reader.error());
  };
  if (Status good = check_in(readers_, picture(), column, row); !good) return good;
  return for_each_mask_tile(column, row, [&](std::int64_t u, std::int64_t v) {
    return check_in(*mask_readers_, level_.mask->picture, u, v);
  });
}

Result<Image> TiffTileLevel::colours(std::int64_t column, std::int64_t row, const ColourConverter& converter) {
  const auto pixels = samples(column, row);
  if (!pixels) return pixels.error();
  const auto clear = opacity(column, row);
  if (!clear) return clear.error();
  Image image{.width_px = static_cast<int>(picture().tile_width_px),
              .height_px = static_cast<int>(picture().tile_height_px),
              .rgba = {}};
  const auto count = static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px);
  image.rgba.resize(count * 4);
  converter.to_rgba(pixels->data(), count, image.rgba.data());
  if (!clear->empty()) clear_colours(clear->data(), count, image.rgba.data());
  return image;
}

Result<Numbers> TiffTileLevel::numbers(std::int64_t column, std::int64_t row, const NumberCoding& coding) {
  const auto pixels = samples(column, row);
  if (!pixels) return pixels.error();
  const auto clear = opacity(column, row);
  if (!clear) return clear.error();
  Numbers numbers{.width_px = static_cast<int>(picture().tile_width_px),
                  .height_px = static_cast<int>(picture().tile_height_px),
                  .values = {}};
  const auto count = static_cast<std::size_t>(numbers.width_px) * static_cast<std::size_t>(numbers.height_px);
  numbers.values.resize(count);
  to_floats(picture().samples, coding, pixels->data(), count, numbers.values.data());
  if (!clear->empty()) clear_numbers(clear->data(), count, numbers.values.data());
  return numbers;
}

Result<double> TiffTileLevel::exact_sample_at(std::int64_t x, std::int64_t y, std::size_t band) {
  const std::int64_t width = picture().tile_width_px, height = picture().tile_height_px;
  const auto pixels = samples(x / width, y / height);
  if (!pixels) return pixels.error();
  const auto pixel = static_cast<std::size_t>((y % height) * width + x % width);
  return exact_sample(picture().samples, band, pixels->data() + pixel * picture().samples.pixel_bytes());
}

TiffRowLevel::TiffRowLevel(TiffLevel level, int jobs) : rows_(std::move(level.part), jobs) {
  if (level.mask) mask_ = std::make_unique<TiffSampleRows>(*std::move(level.mask), jobs);
}

Result<const std::uint8_t*> TiffRowLevel::opacity(std::int64_t y) {
  if (!mask_) return static_cast<const std::uint8_t*>(nullptr);
  const auto row = mask_->read(y);
  if (!row) return row.error();
  opacity_.resize(static_cast<std::size_t>(picture().width_px));
  mask_to_opacity(mask_->picture().samples, *row, opacity_.size(), opacity_.data());
  return static_cast<const std::uint8_t*>(opacity_.data());
}

Status TiffRowLevel::colours(std::int64_t y, const ColourConverter& converter, std::uint8_t* rgba) {
  const auto row = rows_.read(y);
  if (!row) return row.error();
  const auto clear = opacity(y);
  if (!clear) return clear.error();
  const auto pixels = static_cast<std::size_t>(picture().width_px);
  converter.to_rgba(*row, pixels, rgba);
  if (*clear != nullptr) clear_colours(*clear, pixels, rgba);
  return Done{};
}

Status TiffRowLevel::numbers(std::int64_t y, const NumberCoding& coding, float* numbers) {
  const auto row = rows_.read(y);
  if (!row) return row.error();
  const auto clear = opacity(y);
  if (!clear) return clear.error();
  const auto pixels = static_cast<std::size_t>(picture().width_px);
  to_floats(picture().samples, coding, *row, pixels, numbers);
  if (*clear != nullptr) clear_numbers(*clear, pixels, numbers);
  return Done{};
}

}  // namespace terrella
