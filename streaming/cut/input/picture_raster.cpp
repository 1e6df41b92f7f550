#include "streaming/cut/input/picture_raster.h"

#include <cstring>
#include <utility>

#include "streaming/cut/input/height_samples.h"
#include "streaming/cut/input/row_reader.h"
#include "streaming/file_bytes.h"
#include "streaming/raster/picture_kind.h"
#include "streaming/raster/rows/row_raster.h"

namespace terrella {
namespace {

Result<std::unique_ptr<RowReader>> open_picture_rows(const std::filesystem::path& path, const RasterOptions& options) {
  if (!options.heights) {
    return open_rows(path,
                     {.nodata = options.nodata, .scale = {}, .offset = {}, .band = {}, .composite = options.composite},
                     options.jobs);
  }
  HeightCoding coding;
  coding.nodata = options.nodata;
  return open_height_rows(path, coding, options.jobs);
}

/// Applies the scale and the offset to a row of stored numbers.
void scale_numbers(const RasterOptions& options, std::span<std::uint8_t> row) {
  const double scale = options.scale.value_or(1.0);
  const double offset = options.offset.value_or(0.0);
  for (std::size_t i = 0; i + sizeof(float) <= row.size(); i += sizeof(float)) {
    float number = 0.0F;
    std::memcpy(&number, row.data() + i, sizeof(number));
    number = static_cast<float>(number * scale + offset);
    std::memcpy(row.data() + i, &number, sizeof(number));
  }
}

}  // namespace

Result<std::unique_ptr<RasterSource>> open_picture_raster(const std::filesystem::path& path, const CrsPlace& place,
                                                          const RasterOptions& options) {
  if (Status regular = check_regular(path); !regular) return regular.error();
  if (picture_kind(path) == PictureKind::raster) return open_raster(path, place, options);
  auto opened = open_picture_rows(path, options);
  if (!opened) return opened.error();
  const PictureInfo& info = (*opened)->info();
  RowPicture picture{.name = path.stem().string(),
                     .pixels = {.width_px = info.width_px,
                                .height_px = info.height_px,
                                .pixel_bytes = info.has_alpha || options.heights ? std::size_t{4} : std::size_t{3}},
                     .is_numbers = options.heights,
                     .next_row = {}};
  // std::function needs a function that can be copied.
  picture.next_row = [rows = std::shared_ptr<RowReader>(*std::move(opened)), options](std::span<std::uint8_t> row) {
    Status read = rows->read_row(row);
    if (read && options.heights) scale_numbers(options, row);
    return read;
  };
  return make_row_raster(std::move(picture), place, options.work_folder);
}

}  // namespace terrella
