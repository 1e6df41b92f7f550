#include "streaming/mosaic/mosaic_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "streaming/file_bytes.h"
#include "streaming/json_fields.h"
#include "streaming/mosaic/overlay_list.h"
#include "streaming/objects/vector/vector_file.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxListBytes = 64UL << 20;

bool is_tiff_name(const fs::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".tif" || extension == ".tiff";
}

/// Pictures without a place of their own, such as previews, are no part of a folder's mosaic.
bool has_place_beside(const fs::path& picture) {
  constexpr std::array kEndings = {".jgw", ".pgw", ".jpgw", ".pngw", ".wld", ".aux.xml"};
  std::error_code failed;
  return std::ranges::any_of(kEndings, [&](const char* ending) {
    const fs::path replaced = fs::path(picture).replace_extension(ending);
    return fs::exists(replaced, failed) || fs::exists(picture.string() + ending, failed);
  });
}

bool is_member(const fs::path& path) {
  if (is_tiff_name(path)) return true;
  const std::string extension = lower_extension(path);
  const bool picture = extension == ".jpg" || extension == ".jpeg" || extension == ".png" || extension == ".webp";
  return picture && has_place_beside(path);
}

/// Calls for each raster of the folder until `call` returns false.
template <class Call>
void for_each_member(const fs::path& folder, Call call) {
  std::error_code failed;
  const auto options = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator entry(folder, options, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    std::error_code vanished;
    if (entry->is_regular_file(vanished) && is_member(entry->path()) && !call(entry->path())) return;
  }
}

bool is_tile_set_folder(const fs::path& folder) {
  std::error_code failed;
  return fs::exists(folder / "tileset.json", failed) || fs::exists(folder / "tilemapresource.xml", failed);
}

bool is_list_name(const fs::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".txt" || extension == ".lst";
}

Result<nlohmann::json> read_list_json(const fs::path& path) {
  const auto text = read_head(path, kMaxListBytes);
  if (!text) return Error{text.error().message};
  return parse_json_object(as_text(*text), kMaxListBytes, path.string());
}

/// Adds a file, or the rasters of a folder in the order of their names.
Status add_entry(MosaicList& list, MosaicEntry entry) {
  std::error_code failed;
  if (!fs::is_directory(entry.path, failed)) {
    list.entries.push_back(std::move(entry));
    return Done{};
  }
  std::vector<fs::path> found;
  for_each_member(entry.path, [&](const fs::path& file) {
    found.push_back(file);
    return true;
  });
  if (found.empty()) return Error{fmt::format("{}: the folder contains no raster (*.tif)", entry.path.string())};
  std::ranges::sort(found);
  for (fs::path& file : found) {
    entry.path = std::move(file);
    list.entries.push_back(entry);
  }
  return Done{};
}

Result<MosaicList> read_lines(const fs::path& path) {
  MosaicList list{.name = path.stem().string(), .attribution = {}, .entries = {}};
  std::ifstream file(path);
  if (!file) return Error{path.string() + ": cannot be read"};
  for (std::string line; std::getline(file, line);) {
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())) != 0) line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    if (Status added = add_entry(list, {.path = path.parent_path() / line}); !added) return added.error();
  }
  if (list.entries.empty()) return Error{path.string() + ": the list names no file; write the path of a raster a line"};
  return list;
}

/// Reads an item of "mosaic": a path, or an object with a path and values that replace the file's own.
Result<MosaicEntry> read_item(const nlohmann::json& item, const fs::path& folder, const std::string& where) {
  if (item.is_string()) return MosaicEntry{.path = folder / item.get<std::string>()};
  if (!item.is_object()) return Error{where + ": an item of \"mosaic\" is neither a path nor an object with \"file\""};
  constexpr std::array kKnown = {"file", "crs", "bounds", "nodata", "scale", "offset"};
  JsonFields fields(item, where);
  fields.refuse_others(kKnown);
  if (!fields.has("file")) fields.fail<int>("file", "is missing in an item of \"mosaic\"");
  MosaicEntry entry{.path = folder / fields.text("file")};
  entry.words.crs = fields.text("crs");
  if (fields.has("nodata")) entry.nodata = fields.number("nodata");
  if (fields.has("scale")) entry.scale = fields.number("scale");
  if (fields.has("offset")) entry.offset = fields.number("offset");
  if (fields.has("bounds")) {
    const nlohmann::json& bounds = item["bounds"];
    const bool four = bounds.is_array() && bounds.size() == 4 &&
                      std::ranges::all_of(bounds, [](const nlohmann::json& side) { return side.is_number(); });
    if (four) {
      entry.words.bounds =
          CrsBounds{bounds[0].get<double>(), bounds[1].get<double>(), bounds[2].get<double>(), bounds[3].get<double>()};
    } else {
      fields.fail<int>("bounds", "must be four numbers: west, south, east, north in units of the coordinate system");
    }
  }
  if (fields.error()) return *fields.error();
  return entry;
}

Result<MosaicList> read_description(const fs::path& path) {
  const auto object = read_list_json(path);
  if (!object) return object.error();
  const std::string where = path.string();
  constexpr std::array kKnown = {"version", "name", "attribution", "mosaic"};
  JsonFields fields(*object, where);
  fields.refuse_others(kKnown);
  if (fields.integer("version", 1) != 1) fields.fail<int>("version", "must be 1");
  MosaicList list{.name = fields.text("name"), .attribution = fields.text("attribution"), .entries = {}};
  if (list.name.empty()) list.name = path.stem().string();
  const nlohmann::json& items = (*object)["mosaic"];
  if (!items.is_array() || items.empty()) fields.fail<int>("mosaic", "must be a list of files");
  if (fields.error()) return *fields.error();
  for (const nlohmann::json& item : items) {
    auto entry = read_item(item, path.parent_path(), where);
    if (!entry) return entry.error();
    if (Status added = add_entry(list, *std::move(entry)); !added) return added.error();
  }
  return list;
}

}  // namespace

bool is_mosaic(const fs::path& path) {
  std::error_code failed;
  if (fs::is_directory(path, failed)) {
    bool found = false;
    if (!is_tile_set_folder(path)) for_each_member(path, [&](const fs::path&) { return !(found = true); });
    return found;
  }
  if (!fs::is_regular_file(path, failed)) return false;
  if (is_list_name(path) || is_kml_name(path)) return true;
  if (lower_extension(path) != ".json") return false;
  const auto object = read_list_json(path);
  return object && object->contains("mosaic");
}

Result<MosaicList> read_mosaic_list(const fs::path& path, const fs::path& unpacked) {
  std::error_code failed;
  const bool is_folder = fs::is_directory(path, failed);
  if (!is_folder && is_kml_name(path)) return read_overlay_list(path, unpacked);
  if (!is_folder) return is_list_name(path) ? read_lines(path) : read_description(path);
  const fs::path whole = fs::absolute(path, failed).lexically_normal();
  const fs::path named = whole.has_filename() ? whole : whole.parent_path();
  MosaicList list{.name = named.filename().string(), .attribution = {}, .entries = {}};
  if (Status added = add_entry(list, {.path = path}); !added) return added.error();
  return list;
}

}  // namespace terrella
