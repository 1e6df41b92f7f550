#include "streaming/mosaic/mosaic_file.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "streaming/file_bytes.h"
#include "streaming/raster/tiff_pyramid.h"
#include "streaming/tiff_open.h"

namespace terrella {
namespace {

Status read_tiff_header(MosaicFile& file) {
  const auto pyramid = read_pyramid(file.path);
  if (!pyramid) return pyramid.error();
  for (const TiffLevel& level : pyramid->levels) {
    const TiffPicture& picture = level.part.picture;
    file.sizes.emplace_back(picture.width_px, picture.height_px);
    file.by_rows = file.by_rows || !picture.tiled || (level.mask && !level.mask->picture.tiled);
  }
  const TiffSamples& samples = pyramid->whole().part.picture.samples;
  file.one_band = samples.colour == TiffColour::gray || samples.colour == TiffColour::gray_inverted;
  file.is_numbers = file.one_band && samples.type != SampleType::uint8;
  const BandMetadata band = pyramid->metadata.band(0);
  file.unit = band.unit;
  file.scale = band.scale;
  file.offset = band.offset;
  file.own_nodata = pyramid->metadata.nodata;
  return Done{};
}

}  // namespace

Status look_at(MosaicFile& file) {
  struct stat found {};
  if (stat(file.path.c_str(), &found) != 0) {
    return Error{
        fmt::format("{}: {}", file.path.string(), errno == ENOENT ? "there is no such file" : std::strerror(errno))};
  }
  if (!S_ISREG(found.st_mode)) return Error{file.path.string() + ": is no regular file"};
  file.bytes = found.st_size;
  file.changed_ns = std::int64_t{found.st_mtim.tv_sec} * 1'000'000'000 + found.st_mtim.tv_nsec;
  return Done{};
}

Status read_header(MosaicFile& file, const MosaicReading& reading) {
  const auto head = read_head(file.path, 8);
  if (!head) return Error{head.error().message};
  if (begins_as_tiff({reinterpret_cast<const char*>(head->data()), head->size()})) return read_tiff_header(file);
  if (!reading.measure) return Error{file.path.string() + ": is no TIFF"};
  const auto picture = reading.measure(file.path);
  if (!picture) return picture.error();
  file.sizes.emplace_back(picture->width_px, picture->height_px);
  file.by_rows = true;
  file.one_band = true;  // the reader of heights refuses others
  return Done{};
}

}  // namespace terrella
