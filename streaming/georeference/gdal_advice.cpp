#include "streaming/georeference/gdal_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "streaming/other_formats.h"
#include "streaming/raster/raster_file.h"

namespace terrella {
namespace {

/// Rounding error that moves no grid line, in pixels.
constexpr double kGridSlack_px = 1e-3;

std::string with_ending(const PictureFile& picture, const char* ending) {
  const auto name = picture.path.stem().string() + ending;
  return shell_word((picture.path.parent_path() / name).string());
}

/// GDAL options for resampling, and for places without pixels.
std::string pixel_options(const PictureFile& picture) {
  if (!picture.raster || picture.raster->header().bands.size() > 1) return "-r bilinear -dstalpha";
  const RasterBand& band = picture.raster->header().bands.front();
  if (band.colour == BandColour::palette) return "-r near";
  switch (band.type) {
    case SampleType::uint16:
      return "-r bilinear -dstnodata 65535";
    case SampleType::int16:
      return "-r bilinear -dstnodata -32768";
    case SampleType::float32:
    case SampleType::float64:
      return "-r bilinear -dstnodata nan";
    default:
      return "-r bilinear -dstalpha";
  }
}

}  // namespace

DegreeGrid grid_over(double west_deg, double south_deg, double east_deg, double north_deg, double pixel_deg) {
  const double exact = 180.0 / pixel_deg;
  const double nearest = std::round(exact);
  const bool is_whole = std::abs(exact - nearest) < kGridSlack_px;
  const double pixel = 180.0 / std::max(1.0, is_whole ? nearest : std::ceil(exact));
  const double x0 = std::floor((west_deg + 180.0) / pixel + kGridSlack_px);
  const double x1 = std::ceil((east_deg + 180.0) / pixel - kGridSlack_px);
  const double y0 = std::max(0.0, std::floor((90.0 - north_deg) / pixel + kGridSlack_px));
  const double y1 = std::min(180.0 / pixel, std::ceil((90.0 - south_deg) / pixel - kGridSlack_px));
  return {.west_deg = -180.0 + x0 * pixel,
          .south_deg = 90.0 - y1 * pixel,
          .east_deg = -180.0 + x1 * pixel,
          .north_deg = 90.0 - y0 * pixel,
          .columns = std::llround(x1 - x0),
          .rows = std::llround(y1 - y0)};
}

std::string warp_command(const PictureFile& picture, const WarpAdvice& advice) {
  const std::string from = advice.from_crs.empty() ? "" : " -s_srs " + shell_word(advice.from_crs);
  return fmt::format("gdalwarp{} -t_srs {} {} {} {}", from, shell_word(advice.to_crs), pixel_options(picture),
                     shell_word(picture.path.string()), with_ending(picture, "-degrees.tif"));
}

std::string name_system_command(const PictureFile& picture) {
  return fmt::format("gdal_translate -a_srs EPSG:CODE {} {}", shell_word(picture.path.string()),
                     with_ending(picture, "-placed.tif"));
}

std::string join_command(const std::vector<std::filesystem::path>& parts) {
  const PictureFile first{.path = parts.front()};
  const std::string list = with_ending(first, "-joined.vrt");
  std::string command = "gdalbuildvrt " + list;
  for (const auto& part : parts) command += " " + shell_word(part.string());
  return fmt::format("{} && gdal_translate {} {}", command, list, with_ending(first, "-joined.tif"));
}

std::string assign_command(const PictureFile& picture) {
  return fmt::format("gdal_translate -a_srs EPSG:CODE -a_ullr WEST NORTH EAST SOUTH {} {}",
                     shell_word(picture.path.string()), with_ending(picture, "-placed.tif"));
}

std::string own_word_command(const PictureFile& picture) {
  return fmt::format("gdal_translate --config GDAL_GEOREF_SOURCES INTERNAL {} {}", shell_word(picture.path.string()),
                     with_ending(picture, "-own.tif"));
}

}  // namespace terrella
