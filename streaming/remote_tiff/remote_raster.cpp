#include "streaming/remote_tiff/remote_raster.h"

#include <fmt/format.h>

#include "streaming/remote/web_address.h"

namespace terrella {

bool is_tiff_address(const Url& tile_set) {
  const auto address = parse_address(tile_set);
  if (!address || tile_set.with_secrets().find('{') != std::string::npos) return false;
  const std::string path = lower_case(address->path);
  return (address->scheme == "http" || address->scheme == "https") &&
         (path.ends_with(".tif") || path.ends_with(".tiff"));
}

Result<std::shared_ptr<const RasterFile>> open_remote_raster(RemoteFile& file) {
  auto opened = RasterFile::open(file.fetching());
  std::string fault = file.take_fault();
  if (!opened && fault.empty() && file.doubt_directories()) {
    opened = RasterFile::open(file.fetching());
    fault = file.take_fault();
  }
  if (!fault.empty()) return Error{fault};
  if (!opened) return opened;
  file.keep_directories();
  return (*opened)->in_strip_blocks();
}

Error no_blocks(const RasterFile& file) {
  const RasterShape& picture = file.header().whole();
  return Error{fmt::format(
      "{}: its picture is stored in strips of {}x{} pixels, and parts of it are read over a network only if 128 rows "
      "of strips have at most {} MiB; download the file and open that, or put a tiled one in its place (gdal_translate "
      "-of COG IN.tif OUT.tif)",
      file.name(), picture.width_px, picture.rows_per_strip, kMostStripBlockBytes >> 20)};
}

}  // namespace terrella
