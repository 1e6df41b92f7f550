#include "streaming/raster/raster_pixels.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace terrella {
namespace {

std::size_t pixel_count(const PixelWindow& window) {
  return static_cast<std::size_t>(window.width_px * window.height_px);
}

Result<std::vector<std::uint8_t>> read_samples(const RasterFile& file, const PixelReading& reading,
                                               const PixelWindow& window) {
  std::vector<std::uint8_t> samples(pixel_count(window) * reading.samples.pixel_bytes());
  if (Status read = file.read(window, reading.bands, reading.samples.type, samples.data()); !read) return read.error();
  return samples;
}

/// Opacity of the pixels; empty without a mask.
Result<std::vector<std::uint8_t>> read_opacity(const RasterFile& file, const PixelWindow& window) {
  std::vector<std::uint8_t> shown;
  if (!file.header().has_mask) return shown;
  shown.resize(pixel_count(window));
  if (Status read = file.read_mask(window, shown.data()); !read) return read.error();
  return shown;
}

}  // namespace

void hide_colours(const std::uint8_t* shown, std::size_t pixels, std::uint8_t* rgba) {
  for (std::size_t i = 0; i < pixels; ++i) {
    rgba[4 * i + 3] = static_cast<std::uint8_t>((rgba[4 * i + 3] * shown[i] + 127) / 255);
  }
}

void hide_numbers(const std::uint8_t* shown, std::size_t pixels, float* numbers) {
  for (std::size_t i = 0; i < pixels; ++i) {
    if (shown[i] < 128) numbers[i] = std::numeric_limits<float>::quiet_NaN();
  }
}

Status read_colours(const RasterFile& file, const PixelReading& reading, const PixelWindow& window,
                    std::uint8_t* rgba) {
  const auto samples = read_samples(file, reading, window);
  if (!samples) return samples.error();
  const auto shown = read_opacity(file, window);
  if (!shown) return shown.error();
  reading.colours->to_rgba(samples->data(), pixel_count(window), rgba);
  hide_colours(shown->data(), shown->size(), rgba);
  return Done{};
}

Status read_numbers(const RasterFile& file, const PixelReading& reading, const PixelWindow& window, float* numbers) {
  const auto samples = read_samples(file, reading, window);
  if (!samples) return samples.error();
  const auto shown = read_opacity(file, window);
  if (!shown) return shown.error();
  to_floats(reading.samples, reading.numbers, samples->data(), pixel_count(window), numbers);
  hide_numbers(shown->data(), shown->size(), numbers);
  return Done{};
}

Result<double> read_exact(const RasterFile& file, const PixelReading& reading, std::int64_t x, std::int64_t y) {
  const auto pixel = read_samples(
      file, reading, {.level = file.header().levels.size() - 1, .x = x, .y = y, .width_px = 1, .height_px = 1});
  if (!pixel) return pixel.error();
  return exact_sample(reading.samples, reading.numbers.band, pixel->data());
}

PixelWindow window_of_block(const RasterHeader& header, std::size_t level, std::int64_t column, std::int64_t row) {
  const RasterShape& shape = header.levels[level];
  PixelWindow window{.level = level, .x = column * shape.block_width_px, .y = row * shape.block_height_px};
  window.width_px = std::min(shape.block_width_px, shape.width_px - window.x);
  window.height_px = std::min(shape.block_height_px, shape.height_px - window.y);
  return window;
}

}  // namespace terrella
