#include "streaming/cut/cut_key.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/hash_mix.h"
#include "streaming/mosaic/mosaic_list.h"
#include "streaming/raster/picture_kind.h"

namespace terrella {
namespace {

/// Increase this number if the cutter's output changes; older files are then no longer found.
constexpr int kKeyVersion = 4;

std::string number_text(const std::optional<double>& number) { return number ? fmt::format("{:a}", *number) : "-"; }

std::string elevation_text(const std::optional<CutElevation>& elevation) {
  if (!elevation) return "-";
  return fmt::format("{},{},{}", number_text(elevation->scale), number_text(elevation->offset),
                     number_text(elevation->nodata));
}

/// Options about numbers; empty for pictures and heights, so that their keys stay as they were.
std::string numbers_text(const CutOptions& options) {
  std::string text;
  if (const auto& numbers = options.numbers) {
    text = fmt::format("|numbers {},{}", numbers->band, number_text(numbers->nodata));
  }
  if (const auto& composite = options.composite) {
    text = "|bands " + number_text(composite->nodata);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto& stretch = composite->stretch[c];
      text += fmt::format(",{} {}", composite->bands[c], stretch ? stretch_text(*stretch) : "-");
    }
  }
  return text;
}

}  // namespace

std::vector<std::filesystem::path> images_of(const CutOptions& options) {
  std::vector<std::filesystem::path> images;
  for (const auto& image : options.images) {
    images.push_back(image);
    const auto list = is_mosaic(image) ? read_mosaic_list(image) : Result<MosaicList>(Error{});
    if (!list) continue;
    for (const MosaicEntry& entry : list->entries) images.push_back(entry.path);
  }
  return images;
}

std::string options_text(const CutOptions& options, std::string place) {
  const MosaicGrid mosaic = options.mosaic.value_or(MosaicGrid{0, 0});
  // The first line of a key holds the options.
  std::ranges::replace(place, '\n', ' ');
  return fmt::format("{}|{}|{}|{}|{}|{}|{}|{}|{}|{}x{}|{}", kKeyVersion, options.tile_px, options.quality,
                     options.format ? static_cast<int>(*options.format) : -1, place,
                     static_cast<int>(options.projection), options.name, options.attribution, options.body,
                     mosaic.columns, mosaic.rows, elevation_text(options.elevation)) +
         numbers_text(options) + (options.grid == CutGrid::web_mercator ? "|web mercator" : "");
}

Result<std::string> cut_key(const CutOptions& options, const std::string& place) {
  std::string key = options_text(options, place);
  if (options.raster) return key + fmt::format("\n{}", options.raster->key);
  for (const auto& image : images_of(options)) {
    struct stat found {};
    if (stat(file_of(image).c_str(), &found) != 0) {
      if (errno == ENOENT) return Error{fmt::format("{}: no such file", image.string())};
      return Error{fmt::format("{}: cannot be opened: {}", image.string(), std::strerror(errno))};
    }
    key += fmt::format("\n{}|{}|{}.{}", image.filename().string(), found.st_size, found.st_mtim.tv_sec,
                       found.st_mtim.tv_nsec);
  }
  return key;
}

std::string cut_mark(const std::string& key) {
  return fmt::format("{:016x}", name_hash(key.substr(key.find('\n') + 1)));
}

std::string last_change_of(const std::vector<std::filesystem::path>& images) {
  std::time_t newest = 0;
  for (const auto& image : images) {
    struct stat found {};
    if (stat(file_of(image).c_str(), &found) == 0) newest = std::max(newest, found.st_mtim.tv_sec);
  }
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.000Z", fmt::gmtime(newest));
}

}  // namespace terrella
