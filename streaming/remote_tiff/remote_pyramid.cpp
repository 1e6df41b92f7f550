#include "streaming/remote_tiff/remote_pyramid.h"

#include <fmt/format.h>

#include <algorithm>

#include "streaming/remote/web_address.h"

namespace terrella {

bool is_tiff_address(const Url& tile_set) {
  const auto address = parse_address(tile_set);
  if (!address || tile_set.with_secrets().find('{') != std::string::npos) return false;
  const std::string path = lower_case(address->path);
  return (address->scheme == "http" || address->scheme == "https") &&
         (path.ends_with(".tif") || path.ends_with(".tiff"));
}

Result<TiffPyramid> read_remote_pyramid(RemoteFile& file) {
  auto pyramid = read_pyramid(file.fetching());
  std::string fault = file.take_fault();
  if (!pyramid && fault.empty() && file.doubt_directories()) {
    pyramid = read_pyramid(file.fetching());
    fault = file.take_fault();
  }
  if (!fault.empty()) return Error{fault};
  if (!pyramid) return pyramid;
  file.keep_directories();
  for (TiffLevel& level : pyramid->levels) {
    static_cast<void>(make_strip_blocks(level.part.picture));
    if (level.mask) static_cast<void>(make_strip_blocks(level.mask->picture));
  }
  pyramid->levels.erase(std::remove_if(pyramid->levels.begin(), pyramid->levels.end() - 1,
                                       [](const TiffLevel& overview) { return !overview.has_blocks(); }),
                        pyramid->levels.end() - 1);
  return pyramid;
}

Error no_blocks(const std::string& name, const TiffPyramid& pyramid) {
  const TiffPicture& picture = pyramid.whole().part.picture;
  return Error{fmt::format(
      "{}: its picture is stored in strips of {}x{} pixels, and parts of it are read over a network only if 128 rows "
      "of "
      "strips have at most {} MiB; download the file and open that, or put a tiled one in its place (gdal_translate "
      "-of COG IN.tif OUT.tif)",
      name, picture.width_px, picture.rows_per_strip, kMostStripBlockBytes >> 20)};
}

}  // namespace terrella
