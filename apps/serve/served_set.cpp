#include "apps/serve/served_set.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>

#include "apps/open_scene/dated_files.h"
#include "apps/open_scene/open_imagery.h"
#include "apps/open_scene/open_rasters.h"
#include "apps/serve/web_request.h"
#include "streaming/convert/web_tiles.h"
#include "streaming/file_bytes.h"
#include "streaming/pmtiles/pmtiles_format.h"
#include "streaming/remote/describe_remote.h"
#include "streaming/sets/open_tile_set.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Name in addresses that belongs to no set: /wmts is the service of all sets.
constexpr const char* kTakenName = "wmts";

struct NamedSet {
  std::string name;  ///< empty: that of the file
  std::string path;
};

/// Splits NAME=SET, unless a file has the whole text as its name.
NamedSet named_set(const std::string& argument) {
  std::error_code unknown;
  const std::size_t equals = argument.find('=');
  const bool is_path = equals == argument.npos || argument.substr(0, equals).find_first_of("/:?") != argument.npos ||
                       fs::exists(argument, unknown);
  if (is_path) return {.name = {}, .path = argument};
  return {.name = argument.substr(0, equals), .path = argument.substr(equals + 1)};
}

std::string name_of_file(const std::string& path) {
  const fs::path file = fs::path(path).filename().empty() ? fs::path(path).parent_path() : fs::path(path);
  std::string name = file.stem().string();
  std::ranges::replace_if(name, std::not_fn(is_plain_in_addresses), '-');
  name.erase(0, name.find_first_not_of('.'));
  return name.empty() ? "set" : name;
}

bool is_taken(const std::vector<ServedSet>& sets, const std::string& name) {
  return name == kTakenName || std::ranges::find(sets, name, &ServedSet::name) != sets.end();
}

Result<std::string> choose_name(const NamedSet& named, const std::vector<ServedSet>& sets) {
  if (named.name.empty()) {
    const std::string stem = name_of_file(named.path);
    std::string name = stem;
    for (int number = 2; is_taken(sets, name); ++number) name = fmt::format("{}-{}", stem, number);
    return name;
  }
  const bool plain = named.name.front() != '.' && name_of_file(named.name + ".set") == named.name;
  if (!plain) return Error{named.name + ": a name has letters, digits and the characters . _ - alone, and no . first"};
  if (is_taken(sets, named.name)) return Error{named.name + ": this name is taken; give the set another one"};
  return named.name;
}

/// Opens the file for byte ranges if it is a PMTiles archive.
Result<std::shared_ptr<const Descriptor>> open_archive(const std::string& path) {
  const auto head = read_head(path, kPmtilesHeaderBytes);
  if (!head || !begins_as_pmtiles(*head)) return std::shared_ptr<const Descriptor>();
  auto file = std::make_shared<const Descriptor>(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file->number() < 0) return Error{fmt::format("{}: cannot be opened: {}", path, std::strerror(errno))};
  return file;
}

Result<ServedSet> open_served_set(const std::string& path, std::string name) {
  const Url address = path;
  if (is_remote(address)) {
    return Error{fmt::format("{}: tiles of a server are not passed on; fill a file with ‹preload› and serve that file",
                             address.redacted())};
  }
  if (names_dated_files(address)) {
    return Error{path + ": a pattern names the files of many times; serve each file on its own, as NAME=FILE"};
  }
  if (names_mosaic(address) || is_picture(path)) {
    auto made = open_any_tiles({.address = address});
    if (!made) return made.error();
    if ((*made)->info().numbers) {
      return Error{
          fmt::format("{}: its pixels are numbers, of which no pictures are made; ‹cut› it into a tile set of "
                      "numbers and serve that, or a tile set of pictures",
                      address.redacted())};
    }
    return ServedSet{.name = std::move(name), .tiles = *std::move(made), .is_made = true};
  }
  auto stored = open_stored_tile_set(path);
  if (!stored) return stored.error();
  auto archive = open_archive(path);
  if (!archive) return archive.error();
  return ServedSet{.name = std::move(name), .tiles = *std::move(stored), .archive = *std::move(archive)};
}

}  // namespace

MatrixSize matrix_size(const TileSetInfo& info, int level) {
  if (info.square && !info.square->levels.empty()) {
    const CrsLevel& own = info.square->levels.at(static_cast<std::size_t>(level));
    return {.columns = own.columns, .rows = own.rows};
  }
  return {.columns = columns(info.grid, level), .rows = rows(info.grid, level)};
}

int first_zoom(const TileSetInfo& info) {
  return info.grid.projection == Projection::web_mercator ? zoom_of_roots(info.grid) : 0;
}

Result<std::vector<ServedSet>> open_served_sets(const std::vector<std::string>& sets) {
  std::vector<ServedSet> opened;
  opened.reserve(sets.size());
  for (const std::string& argument : sets) {
    const NamedSet named = named_set(argument);
    auto name = choose_name(named, opened);
    if (!name) return name.error();
    auto set = open_served_set(named.path, *std::move(name));
    if (!set) return set.error();
    opened.push_back(*std::move(set));
  }
  return opened;
}

}  // namespace terrella
