#include "streaming/cut/growing/coarse_raster.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "codecs/image.h"
#include "streaming/cut/input/row_formats.h"
#include "streaming/file_bytes.h"
#include "streaming/other_formats.h"
#include "streaming/raster/in_parallel.h"
#include "streaming/raster/picture_kind.h"
#include "streaming/raster/rows/raster_rows.h"
#include "streaming/raster/rows/row_raster.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;
using Coarse = std::unique_ptr<RasterSource>;

/// Longest side that is wished for, pixels.
constexpr std::int64_t kCoarseSide_px = 1400;
/// Most tiles that are decoded, one for a pixel.
constexpr double kSampledTiles = 512.0;

/// A picture of fewer pixels that covers the same area.
struct CoarseShape {
  std::int64_t width_px, height_px;    ///< size of the picture
  std::int64_t columns = 0, rows = 0;  ///< size of the coarse picture
  /// First pixel of a coarse column or row.
  [[nodiscard]] static std::int64_t begin(std::int64_t at, std::int64_t size, std::int64_t count) {
    return at * size / count;
  }
};

/// Place of the coarse picture of a picture of this size.
CrsPlace shrunk(const CrsPlace& place, std::int64_t width_px, std::int64_t height_px, const CoarseShape& shape) {
  CrsPlace coarse = place;
  const double across = static_cast<double>(width_px) / static_cast<double>(shape.columns);
  const double down = static_cast<double>(height_px) / static_cast<double>(shape.rows);
  coarse.to_crs.x_per_column *= across;
  coarse.to_crs.y_per_column *= across;
  coarse.to_crs.x_per_row *= down;
  coarse.to_crs.y_per_row *= down;
  return coarse;
}

Coarse make_coarse(const fs::path& path, const CrsPlace& place, const CoarseShape& shape, BlockStore::NextRow next_row,
                   bool numbers = false) {
  RowPicture picture{.name = path.stem().string(),
                     .pixels = {.width_px = shape.columns, .height_px = shape.rows, .pixel_bytes = 4},
                     .is_numbers = numbers,
                     .next_row = std::move(next_row)};
  return make_row_raster(std::move(picture), place, {});
}

/// Mean of pixels by alpha.
void put_mean(const std::uint8_t* rgba, std::int64_t count, std::uint8_t* to) {
  std::array<std::uint64_t, 4> sums{};
  for (std::int64_t i = 0; i < count; ++i, rgba += 4) {
    for (std::size_t c = 0; c < 3; ++c) sums[c] += std::uint64_t{rgba[c]} * rgba[3];
    sums[3] += rgba[3];
  }
  for (std::size_t c = 0; c < 3; ++c) to[c] = static_cast<std::uint8_t>(sums[3] > 0 ? sums[c] / sums[3] : 0);
  to[3] = static_cast<std::uint8_t>(sums[3] / static_cast<std::uint64_t>(count));
}

/// Mean of the known numbers.
void put_mean(const float* numbers, std::int64_t count, std::uint8_t* to) {
  double sum = 0.0;
  std::int64_t known = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    if (std::isnan(numbers[i])) continue;
    sum += static_cast<double>(numbers[i]);
    ++known;
  }
  const auto mean =
      known > 0 ? static_cast<float>(sum / static_cast<double>(known)) : std::numeric_limits<float>::quiet_NaN();
  std::memcpy(to, &mean, sizeof(mean));
}

/// Some of a raster's rows, or of its tiles.
struct CoarseRows {
  CoarseShape shape;
  std::shared_ptr<const RasterFile> file;
  PixelReading reading;
  bool numbers = false;                 ///< instead of colours
  std::unique_ptr<RasterRows> by_rows;  ///< null: tiles are read
  std::vector<std::uint8_t> row{};
  std::vector<float> number_row{};
  std::int64_t next = 0;

  /// One row in the middle, or the first one of a strip: strips are decoded from the top.
  [[nodiscard]] Status put_rows(std::span<std::uint8_t> to) {
    const std::int64_t first = CoarseShape::begin(next, shape.height_px, shape.rows);
    const std::int64_t end = std::max(first + 1, CoarseShape::begin(next + 1, shape.height_px, shape.rows));
    const std::int64_t strip = by_rows->shape().tiled ? 1 : by_rows->shape().rows_per_strip;
    const std::int64_t start = (first + end) / 2 / strip * strip;
    const std::int64_t y = start >= first ? start : (first + end) / 2;
    row.resize(numbers ? 0 : static_cast<std::size_t>(shape.width_px) * 4);
    number_row.resize(numbers ? static_cast<std::size_t>(shape.width_px) : 0);
    Status read = numbers ? by_rows->numbers(y, number_row.data()) : by_rows->colours(y, row.data());
    if (!read) return read;
    for (std::int64_t x = 0; x < shape.columns; ++x) {
      const std::int64_t left = CoarseShape::begin(x, shape.width_px, shape.columns);
      const std::int64_t right = CoarseShape::begin(x + 1, shape.width_px, shape.columns);
      const std::int64_t count = std::max<std::int64_t>(1, right - left);
      numbers ? put_mean(number_row.data() + left, count, to.data() + x * 4)
              : put_mean(row.data() + left * 4, count, to.data() + x * 4);
    }
    return Done{};
  }

  /// A pixel for each of some tiles. A tile that cannot be read is transparent; the cut will tell.
  void put_tiles(std::span<std::uint8_t> to) {
    const RasterShape& level = file->header().levels.front();
    const std::int64_t tile_columns = (level.width_px + level.block_width_px - 1) / level.block_width_px;
    const std::int64_t tile_rows = (level.height_px + level.block_height_px - 1) / level.block_height_px;
    const std::int64_t tile_row = (2 * next + 1) * tile_rows / (2 * shape.rows);
    in_parallel(thread_count(0), shape.columns, [&](std::int64_t x) {
      PixelWindow window =
          window_of_block(file->header(), 0, (2 * x + 1) * tile_columns / (2 * shape.columns), tile_row);
      // A row through the middle is a fair mean.
      window.y += window.height_px / 2;
      window.height_px = 1;
      const auto wide = static_cast<std::size_t>(window.width_px);
      std::vector<float> values(numbers ? wide : 0, std::numeric_limits<float>::quiet_NaN());
      std::vector<std::uint8_t> rgba(numbers ? 0 : wide * 4);
      if (numbers) {
        static_cast<void>(read_numbers(*file, reading, window, values.data()));
        put_mean(values.data(), window.width_px, to.data() + x * 4);
      } else if (read_colours(*file, reading, window, rgba.data())) {
        put_mean(rgba.data(), window.width_px, to.data() + x * 4);
      }
    });
  }
};

Result<Coarse> open_coarse_rows(const fs::path& path, const CrsPlace& place, const CoarseChoice& choice) {
  const auto opened = RasterFile::open(path.string());
  if (!opened) return opened.error();
  const RasterHeader& header = (*opened)->header();
  auto reading = choice.numbers ? numbers_of(**opened, choice.coding) : colours_of(**opened, choice.coding);
  if (!reading) return reading.error();
  const RasterShape& picture = header.levels.front();
  const double by = std::max(1.0, static_cast<double>(std::max(picture.width_px, picture.height_px)) / kCoarseSide_px);
  CoarseShape shape{.width_px = picture.width_px, .height_px = picture.height_px};
  shape.columns = std::max<std::int64_t>(1, std::llround(static_cast<double>(picture.width_px) / by));
  shape.rows = std::max<std::int64_t>(1, std::llround(static_cast<double>(picture.height_px) / by));
  // A long compressed strip would be decoded as a whole.
  if (!picture.tiled && header.is_compressed &&
      picture.rows_per_strip > std::max<std::int64_t>(64, 4 * shape.height_px / shape.rows)) {
    return Coarse{};
  }
  auto some = std::make_shared<CoarseRows>(CoarseRows{shape, *opened, *reading, choice.numbers, {}});
  const auto tiles = [](std::int64_t pixels, std::int64_t each) {
    return static_cast<double>((pixels + each - 1) / each);
  };
  const double columns = picture.tiled ? tiles(picture.width_px, picture.block_width_px) : 0.0;
  const double rows = picture.tiled ? tiles(picture.height_px, picture.block_height_px) : 0.0;
  if (columns * rows > kSampledTiles) {
    const double part = std::sqrt(kSampledTiles / (columns * rows));
    some->shape.columns = std::max<std::int64_t>(1, std::llround(columns * part));
    some->shape.rows = std::max<std::int64_t>(1, std::llround(rows * part));
  } else {
    some->by_rows = std::make_unique<RasterRows>(*opened, 0, *std::move(reading), 0);
  }
  const CrsPlace at = shrunk(place, header.whole().width_px, header.whole().height_px, some->shape);
  return make_coarse(
      path, at, some->shape,
      [some](std::span<std::uint8_t> row) -> Status {
        Status read = Done{};
        if (some->by_rows) {
          read = some->put_rows(row);
        } else {
          some->put_tiles(row);
        }
        ++some->next;
        return read;
      },
      choice.numbers);
}

Result<Coarse> open_coarse_jpeg(const fs::path& path, const CrsPlace& place) {
  const auto open = [&](int eighths) -> Result<std::unique_ptr<RowReader>> {
    File file(std::fopen(path.c_str(), "rb"));
    if (!file) return Error{fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno))};
    return open_jpeg_rows(std::move(file), path.string(), eighths);
  };
  const auto whole = open(8);
  if (!whole) return whole.error();
  const PictureInfo& info = (*whole)->info();
  const std::int64_t side = std::max(info.width_px, info.height_px);
  auto opened = open(side >= 8 * kCoarseSide_px   ? 1
                     : side >= 4 * kCoarseSide_px ? 2
                     : side >= 2 * kCoarseSide_px ? 4
                                                  : 8);
  if (!opened) return opened.error();
  const PictureInfo& small = (*opened)->info();
  const CoarseShape shape{info.width_px, info.height_px, small.width_px, small.height_px};
  return make_coarse(path, shrunk(place, info.width_px, info.height_px, shape), shape,
                     [rows = std::shared_ptr<RowReader>(*std::move(opened))](std::span<std::uint8_t> row) {
                       return rows->read_row(row);
                     });
}

}  // namespace

Result<Coarse> open_coarse_raster(const fs::path& path, const CrsPlace& place, const CoarseChoice& choice) {
  const auto head = read_head(path, kFormatHeadBytes);
  if (!head) return Error{head.error().message};
  if (picture_kind(path) == PictureKind::raster) return open_coarse_rows(path, place, choice);
  if (!choice.numbers && sniff_format(*head) == ImageFormat::jpeg) return open_coarse_jpeg(path, place);
  return Coarse{};
}

}  // namespace terrella
