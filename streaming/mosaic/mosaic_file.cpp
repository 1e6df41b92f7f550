#include "streaming/mosaic/mosaic_file.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "streaming/raster/picture_kind.h"
#include "streaming/raster/raster_pixels.h"

namespace terrella {
namespace {

void read_raster_header(const RasterHeader& header, MosaicFile& file) {
  for (const RasterShape& level : header.levels) {
    file.sizes.emplace_back(level.width_px, level.height_px);
    file.by_rows = file.by_rows || !level.has_blocks();
  }
  const RasterBand& band = header.bands.front();
  file.one_band = !colour_bands(header).in_colours();
  file.is_numbers = file.one_band && band.type != SampleType::uint8;
  file.unit = band.unit;
  file.scale = band.scale;
  file.offset = band.offset;
  file.own_nodata = band.nodata;
}

}  // namespace

Status look_at(MosaicFile& file) {
  struct stat found {};
  if (stat(file_of(file.path).c_str(), &found) != 0) {
    return Error{
        fmt::format("{}: {}", file.path.string(), errno == ENOENT ? "there is no such file" : std::strerror(errno))};
  }
  if (!S_ISREG(found.st_mode)) return Error{file.path.string() + ": is no regular file"};
  file.bytes = found.st_size;
  file.changed_ns = std::int64_t{found.st_mtim.tv_sec} * 1'000'000'000 + found.st_mtim.tv_nsec;
  return Done{};
}

Status read_header(MosaicFile& file, const MosaicReading& reading) {
  const auto picture = reading.measure(file.path);
  if (!picture) return picture.error();
  file.raster = picture->raster;
  if (file.raster) {
    read_raster_header(file.raster->header(), file);
    return Done{};
  }
  file.sizes.emplace_back(picture->width_px, picture->height_px);
  file.by_rows = true;
  file.one_band = true;  // the reader of heights refuses others
  return Done{};
}

}  // namespace terrella
