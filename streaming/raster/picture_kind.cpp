#include "streaming/raster/picture_kind.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "codecs/image.h"
#include "streaming/file_bytes.h"
#include "streaming/raster/gdal/gdal_library.h"
#include "streaming/raster/tiff_tags.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// First bytes of tile sets and descriptions, which are no rasters although GDAL opens some of them.
bool begins_as_tile_set(std::string_view head) {
  const auto begins = [head](std::string_view text) { return head.starts_with(text); };
  return begins("SQLite format 3") || begins("PMTiles") || begins("{") || begins("[") || begins("<GDAL_WMS") ||
         begins("<TileMap");
}

bool gdal_identifies(const std::string& name) {
  const GdalSettings settings(GdalSettings::Settings{{"GDAL_DISABLE_READDIR_ON_OPEN", "TRUE"}});
  const GdalMessages messages;
  return gdal().GDALIdentifyDriverEx(name.c_str(), GDAL_OF_RASTER, gdal().drivers.data(), nullptr) != nullptr;
}

bool is_named_as_raster(const fs::path& path) {
  constexpr std::array kEndings = {".jp2", ".j2k", ".vrt", ".nc", ".hdf", ".h5", ".fits", ".cub", ".lbl", ".img"};
  return std::ranges::find(kEndings, path.extension()) != kEndings.end();
}

/// The file in GDAL's name of a sub-dataset: PREFIX:"FILE":REST or PREFIX:FILE:REST.
fs::path file_of_sub_dataset(const std::string& name) {
  const std::size_t prefix = name.find(':');
  if (prefix == std::string::npos) return {};
  const bool quoted = name.compare(prefix + 1, 1, "\"") == 0;
  const std::size_t from = prefix + (quoted ? 2 : 1);
  const std::size_t to = name.find(quoted ? '"' : ':', from);
  return to == std::string::npos ? fs::path(name.substr(from)) : fs::path(name.substr(from, to - from));
}

}  // namespace

fs::path file_of(const fs::path& picture) {
  std::error_code failed;
  if (fs::exists(picture, failed)) return picture;
  const fs::path part_of = file_of_sub_dataset(picture.string());
  return fs::is_regular_file(part_of, failed) ? part_of : picture;
}

PictureKind picture_kind(const fs::path& path) {
  std::error_code failed;
  const std::string name = path.string();
  if (!fs::is_regular_file(path, failed)) {
    const bool is_part = file_of(path) != path && load_gdal() && gdal_identifies(name);
    return is_part ? PictureKind::raster : PictureKind::none;
  }
  const auto bytes = read_head(path, 64);
  if (!bytes) return PictureKind::none;
  const std::string_view head = as_text(*bytes);
  if (sniff_format(*bytes) != ImageFormat::unknown) return PictureKind::plain;
  if (begins_as_tiff(head)) return PictureKind::raster;
  if (begins_as_tile_set(head)) return PictureKind::none;
  const bool is_raster = load_gdal() ? gdal_identifies(name) : is_named_as_raster(path);
  return is_raster ? PictureKind::raster : PictureKind::none;
}

bool begins_as_picture(const fs::path& path) {
  const auto head = read_head(path, 12);
  return head && (sniff_format(*head) != ImageFormat::unknown || begins_as_tiff(as_text(*head)));
}

}  // namespace terrella
