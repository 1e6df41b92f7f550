#include "streaming/raster/tiff_stretch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "streaming/raster/tiff_level.h"

namespace terrella {
namespace {

constexpr std::int64_t kSampledPieces = 64;
constexpr std::int64_t kSampledPixels = 1 << 25;

/// Number of pieces to read, of `count` pieces of `pixels` pixels each.
std::int64_t pieces_to_read(std::int64_t count, std::int64_t pixels) {
  return std::clamp<std::int64_t>(kSampledPixels / pixels, 1, std::min(count, kSampledPieces));
}

Status sample_tiles(const TiffLevel& level, const NumberCoding& coding, std::vector<float>& values) {
  TiffTileLevel tiles(level);
  const TiffPicture& picture = level.part.picture;
  const std::int64_t count = picture.tile_columns() * picture.tile_rows();
  const std::int64_t reads = pieces_to_read(count, picture.tile_width_px * picture.tile_height_px);
  for (std::int64_t i = 0; i < reads; ++i) {
    const std::int64_t at = (2 * i + 1) * count / (2 * reads);
    const std::int64_t column = at % picture.tile_columns();
    const std::int64_t row = at / picture.tile_columns();
    const auto numbers = tiles.numbers(column, row, coding);
    if (!numbers) return Error{fmt::format("{}: {}", level.part.file->name(), numbers.error().message)};
    const auto wide =
        static_cast<std::size_t>(std::min(picture.tile_width_px, picture.width_px - column * picture.tile_width_px));
    const std::int64_t high = std::min(picture.tile_height_px, picture.height_px - row * picture.tile_height_px);
    for (std::int64_t y = 0; y < high; ++y) {
      const float* from = numbers->values.data() + y * picture.tile_width_px;
      values.insert(values.end(), from, from + wide);
    }
  }
  return Done{};
}

Status sample_rows(const TiffLevel& level, const NumberCoding& coding, std::vector<float>& values) {
  TiffRowLevel rows(level, 0);
  const TiffPicture& picture = level.part.picture;
  const std::int64_t reads = pieces_to_read(picture.height_px, picture.width_px);
  std::vector<float> row(static_cast<std::size_t>(picture.width_px));
  for (std::int64_t i = 0; i < reads; ++i) {
    const std::int64_t y = (2 * i + 1) * picture.height_px / (2 * reads);
    if (Status read = rows.numbers(y, coding, row.data()); !read) return read;
    values.insert(values.end(), row.begin(), row.end());
  }
  return Done{};
}

/// The value below which a share of the values lies. Reorders the values.
double percentile(std::vector<float>& values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1) + 0.5);
  std::ranges::nth_element(values, values.begin() + at);
  return static_cast<double>(values[static_cast<std::size_t>(at)]);
}

Status add_samples(const TiffLevel& level, const NumberCoding& coding, std::vector<float>& values) {
  return level.has_blocks() ? sample_tiles(level, coding, values) : sample_rows(level, coding, values);
}

Result<Stretch> range_of_samples(const TiffLevel& level, const std::optional<double>& nodata) {
  std::vector<float> values;
  for (std::size_t band = 0; band < level.part.picture.samples.colours(); ++band) {
    if (Status read = add_samples(level, {.band = band, .nodata = nodata}, values); !read) return read.error();
  }
  std::erase_if(values, [](float value) { return !std::isfinite(value); });
  if (values.empty()) return Stretch{.low = 0.0, .high = 1.0};
  const double low = percentile(values, 0.02);
  return Stretch{.low = low, .high = percentile(values, 0.98)};
}

}  // namespace

Result<std::vector<float>> sample_band(const TiffLevel& level, const NumberCoding& coding) {
  std::vector<float> values;
  if (Status read = add_samples(level, coding, values); !read) return read.error();
  return values;
}

Result<std::optional<Stretch>> find_stretch(const TiffPyramid& pyramid, const std::optional<double>& nodata) {
  const TiffSamples& samples = pyramid.levels.front().part.picture.samples;
  if (samples.type == SampleType::uint8 || samples.colour == TiffColour::palette) return std::optional<Stretch>{};
  Stretch range;
  const TiffMetadata& metadata = pyramid.metadata;
  if (metadata.least && metadata.most) {
    range = {.low = *metadata.least, .high = *metadata.most};
  } else {
    const auto sampled = range_of_samples(pyramid.levels.front(), nodata);
    if (!sampled) return sampled.error();
    range = *sampled;
  }
  // Values up to the upper half of 16 bits or fewer fill enough of the range to be shown unstretched.
  const double upper_half = std::ldexp(1.0, samples.stored_bits - 1);
  if (samples.type == SampleType::uint16 && range.high >= upper_half) return std::optional<Stretch>{};
  // A picture of one value is shown in the middle of the range.
  if (!(range.low < range.high)) range = {.low = range.low - 0.5, .high = range.low + 0.5};
  return std::optional(range);
}

}  // namespace terrella
