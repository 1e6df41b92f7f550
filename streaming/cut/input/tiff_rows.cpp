#include <cstring>
#include <optional>
#include <vector>

#include "streaming/cut/input/row_formats.h"
#include "streaming/raster/tiff_coding.h"
#include "streaming/raster/tiff_level.h"

namespace terrella {
namespace {

/// Rows of the first picture in a TIFF, with its mask.
class TiffRows : public RowReader {
 public:
  TiffRows(const TiffLevel& level, ColourConverter colours, int jobs)
      : rows_(level, jobs), colours_(std::move(colours)) {
    set_size();
    info_.has_alpha = level.mask.has_value() || colours_->samples().may_be_clear();
  }
  TiffRows(const TiffLevel& level, const HeightCoding& heights, int jobs)
      : rows_(level, jobs), heights_(heights), numbers_(static_cast<std::size_t>(level.part.picture.width_px)) {
    set_size();
  }

  [[nodiscard]] const PictureInfo& info() const override { return info_; }

  [[nodiscard]] Status read_row(std::span<std::uint8_t> rgba) override {
    const std::int64_t y = row_++;
    if (colours_) return rows_.colours(y, *colours_, rgba.data());
    const NumberCoding stored{.band = heights_.band,
                              .nodata = heights_.nodata,
                              .scale = heights_.sample_scale,
                              .offset = heights_.sample_offset};
    if (Status read = rows_.numbers(y, stored, numbers_.data()); !read) return read;
    to_numbers(heights_, numbers_);
    std::memcpy(rgba.data(), numbers_.data(), rgba.size());
    return Done{};
  }

  [[nodiscard]] Status skip_rows(std::int64_t rows) override {
    row_ += rows;
    return Done{};
  }

 private:
  void set_size() {
    info_.width_px = rows_.picture().width_px;
    info_.height_px = rows_.picture().height_px;
  }

  TiffRowLevel rows_;
  std::optional<ColourConverter> colours_;  ///< none: heights
  HeightCoding heights_;
  std::vector<float> numbers_;
  PictureInfo info_;
  std::int64_t row_ = 0;
};

}  // namespace

Result<std::unique_ptr<RowReader>> open_tiff_rows(const std::string& name, const std::optional<HeightCoding>& heights,
                                                  const CodingOptions& choice, int jobs) {
  const auto pyramid = read_pyramid(name);
  if (!pyramid) return pyramid.error();
  if (heights) return std::unique_ptr<RowReader>(std::make_unique<TiffRows>(pyramid->whole(), *heights, jobs));
  auto colours = colours_of(*pyramid, choice);
  if (!colours) return colours.error();
  return std::unique_ptr<RowReader>(std::make_unique<TiffRows>(pyramid->whole(), *std::move(colours), jobs));
}

}  // namespace terrella
