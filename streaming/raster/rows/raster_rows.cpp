#include "streaming/raster/rows/raster_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <optional>

#include "streaming/raster/in_parallel.h"

namespace terrella {
namespace {

/// Memory for rows of strips that are decoded together, bytes.
constexpr std::int64_t kStripsBytes = 8LL << 20;
/// Memory for a row of tiles, bytes. A larger one is read in parts, and its tiles are decoded once for each. 86400
/// pixels of RGB with tiles of 256 rows fit.
constexpr std::int64_t kTilesBytes = 64LL << 20;

}  // namespace

RasterRows::RasterRows(std::shared_ptr<const RasterFile> file, std::size_t level, PixelReading reading, int jobs)
    : file_(std::move(file)), level_(level), reading_(std::move(reading)), jobs_(thread_count(jobs)) {}

/// Number of rows that are read together from `y` on.
std::int64_t RasterRows::rows_from(std::int64_t y) const {
  const RasterShape& level = shape();
  const auto row_bytes = static_cast<std::int64_t>(reading_.samples.pixel_bytes()) * level.width_px;
  if (level.tiled) {
    // As few parts of equal height as possible.
    const std::int64_t fit = std::max<std::int64_t>(1, kTilesBytes / row_bytes), tile = level.block_height_px;
    const std::int64_t parts = (tile + fit - 1) / fit, part = (tile + parts - 1) / parts, in_tile = y % tile;
    return std::min({part - in_tile % part, tile - in_tile, level.height_px - y});
  }
  const std::int64_t strip = level.rows_per_strip;
  const std::int64_t to_end_of_strip = strip - y % strip;
  // Rows that are left out are not read ahead.
  if (y != held_from_ + held_rows_) return std::min(to_end_of_strip, level.height_px - y);
  const std::int64_t strips = std::max<std::int64_t>(1, kStripsBytes / (row_bytes * strip));
  return std::min(to_end_of_strip + (strips - 1) * strip, level.height_px - y);
}

/// Decodes the rows from `y` on that are read together.
Status RasterRows::hold(std::int64_t y) {
  const RasterShape& level = shape();
  const std::int64_t rows = rows_from(y);
  held_from_ = y;
  held_rows_ = rows;
  const std::size_t pixel = reading_.samples.pixel_bytes();
  const std::size_t row_bytes = static_cast<std::size_t>(level.width_px) * pixel;
  held_.resize(static_cast<std::size_t>(rows) * row_bytes);
  // Other formats decode from the top of the file, and gain nothing from several readers.
  const int jobs = file_->header().driver == "GTiff" ? jobs_ : 1;
  const std::int64_t unit = level.tiled ? level.block_width_px : level.rows_per_strip;
  const std::int64_t extent = level.tiled ? level.width_px : rows;
  const std::int64_t parts = std::clamp<std::int64_t>(extent / unit, 1, jobs);
  const auto edge = [&](std::int64_t part) { return part == parts ? extent : extent / unit * part / parts * unit; };
  std::mutex mutex;
  std::optional<Error> failed;
  in_parallel(jobs, parts, [&](std::int64_t part) {
    const std::int64_t from = edge(part), size = edge(part + 1) - from;
    PixelWindow window{.level = level_, .y = y, .width_px = level.width_px, .height_px = rows};
    (level.tiled ? window.x : window.y) += from;
    (level.tiled ? window.width_px : window.height_px) = size;
    const std::size_t at = static_cast<std::size_t>((window.y - y) * level.width_px + window.x) * pixel;
    const Status read = file_->read(window, reading_.bands, reading_.samples.type, held_.data() + at, row_bytes);
    const std::lock_guard lock(mutex);
    if (!read && !failed) failed = read.error();
  });
  if (!failed && file_->header().has_mask) {
    shown_.resize(static_cast<std::size_t>(rows * level.width_px));
    const PixelWindow window{.level = level_, .y = y, .width_px = level.width_px, .height_px = rows};
    if (const Status read = file_->read_mask(window, shown_.data()); !read) failed = read.error();
  }
  if (!failed) return Done{};
  held_rows_ = 0;
  return Error{fmt::format("{}: row {} of {} cannot be read: {}; the file is truncated or damaged, get it again",
                           file_->name(), y + 1, level.height_px, failed->message)};
}

Status RasterRows::colours(std::int64_t y, std::uint8_t* rgba) {
  if (y < held_from_ || y >= held_from_ + held_rows_) {
    if (Status read = hold(y); !read) return read;
  }
  const auto pixels = static_cast<std::size_t>(shape().width_px);
  const auto row = static_cast<std::size_t>(y - held_from_);
  reading_.colours->to_rgba(held_.data() + row * pixels * reading_.samples.pixel_bytes(), pixels, rgba);
  if (!shown_.empty()) hide_colours(shown_.data() + row * pixels, pixels, rgba);
  return Done{};
}

Status RasterRows::numbers(std::int64_t y, float* numbers) {
  if (y < held_from_ || y >= held_from_ + held_rows_) {
    if (Status read = hold(y); !read) return read;
  }
  const auto pixels = static_cast<std::size_t>(shape().width_px);
  const auto row = static_cast<std::size_t>(y - held_from_);
  to_floats(reading_.samples, reading_.numbers, held_.data() + row * pixels * reading_.samples.pixel_bytes(), pixels,
            numbers);
  if (!shown_.empty()) hide_numbers(shown_.data() + row * pixels, pixels, numbers);
  return Done{};
}

}  // namespace terrella
