#include "apps/viewer/tools/folder_list.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <system_error>
#include <tuple>
#include <utility>

namespace terrella {
namespace {

std::string lowered(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

}  // namespace

bool has_shown_name(const std::filesystem::path& path) {
  constexpr std::array kEndings = {".jpg",     ".jpeg", ".png",     ".tif",  ".tiff", ".webp", ".gpkg", ".mbtiles",
                                   ".pmtiles", ".json", ".geojson", ".gltf", ".glb",  ".xml",  ".wms",  ".lst",
                                   ".txt",     ".kml",  ".kmz",     ".gpx",  ".shp",  ".fgb",  ".csv",  ".terrella"};
  return std::ranges::find(kEndings, lowered(path.extension().string())) != kEndings.end();
}

Result<std::vector<FolderEntry>> list_folder(const std::filesystem::path& folder, bool all) {
  std::error_code failed;
  std::vector<FolderEntry> entries;
  std::filesystem::directory_iterator entry(folder, failed);
  for (; !failed && entry != std::filesystem::directory_iterator(); entry.increment(failed)) {
    FolderEntry found{.name = entry->path().filename().string()};
    std::error_code unknown;
    found.is_folder = entry->is_directory(unknown);
    if (found.name.starts_with('.') || !(found.is_folder || all || has_shown_name(entry->path()))) continue;
    entries.push_back(std::move(found));
  }
  if (failed) {
    return Error{
        fmt::format("{}: the folder cannot be read: {}; choose another folder", folder.string(), failed.message())};
  }
  std::ranges::sort(entries, {},
                    [](const FolderEntry& one) { return std::tuple(!one.is_folder, lowered(one.name), one.name); });
  return entries;
}

}  // namespace terrella
