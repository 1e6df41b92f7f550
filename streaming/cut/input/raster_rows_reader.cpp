#include <cstring>
#include <optional>
#include <vector>

#include "streaming/cut/input/row_formats.h"
#include "streaming/raster/rows/raster_rows.h"

namespace terrella {
namespace {

/// Rows of a raster, with its mask.
class RasterRowReader : public SeekingRows {
 public:
  /// `heights`: none for colours.
  RasterRowReader(const std::shared_ptr<const RasterFile>& file, PixelReading reading,
                  std::optional<HeightCoding> heights, int jobs)
      : rows_(file, file->header().levels.size() - 1, std::move(reading), jobs), heights_(heights) {
    info_.width_px = rows_.shape().width_px;
    info_.height_px = rows_.shape().height_px;
    info_.has_alpha = !heights_ && (file->header().has_mask || rows_.reading().samples.may_be_clear());
    if (heights_) numbers_.resize(static_cast<std::size_t>(info_.width_px));
  }

  [[nodiscard]] const PictureInfo& info() const override { return info_; }

  [[nodiscard]] Status read_row(std::span<std::uint8_t> rgba) override {
    const std::int64_t y = row_++;
    if (!heights_) return rows_.colours(y, rgba.data());
    if (Status read = rows_.numbers(y, numbers_.data()); !read) return read;
    to_numbers(*heights_, numbers_);
    std::memcpy(rgba.data(), numbers_.data(), rgba.size());
    return Done{};
  }

 private:
  RasterRows rows_;
  std::optional<HeightCoding> heights_;
  std::vector<float> numbers_;
  PictureInfo info_;
};

}  // namespace

Result<std::unique_ptr<RowReader>> open_raster_rows(const std::string& name, const std::optional<HeightCoding>& heights,
                                                    const CodingOptions& choice, int jobs) {
  const auto file = RasterFile::open(name);
  if (!file) return file.error();
  auto reading = heights ? numbers_of(**file, {.nodata = heights->nodata,
                                               .scale = heights->sample_scale,
                                               .offset = heights->sample_offset,
                                               .band = heights->band})
                         : colours_of(**file, choice);
  if (!reading) return reading.error();
  return std::unique_ptr<RowReader>(std::make_unique<RasterRowReader>(*file, *std::move(reading), heights, jobs));
}

}  // namespace terrella
