#include "apps/open_scene/open_remote_tiff.h"
#include "apps/open_scene/open_picture.h"

#include <fmt/format.h>

#include <system_error>
#include <utility>
#include <vector>

#include "apps/open_scene/open_cache.h"
#include "apps/process/console.h"
#include "apps/process/stop_signals.h"
#include "streaming/cache/cache_report.h"
#include "streaming/file_bytes.h"
#include "streaming/georeference/figure.h"
#include "streaming/raster/tiff_tags.h"
#include "streaming/remote/describe_remote.h"
#include "streaming/remote/remote_pmtiles.h"
#include "streaming/remote/web_address.h"
#include "streaming/remote_tiff/remote_tiff.h"
#include "streaming/remote_tiff/waiting_raster.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Deletes the cache of an earlier version, or refuses to.
Status discard_old_version(const RemoteTiffWish& wish) {
  if (!wish.may_replace_cache) {
    return Error{
        fmt::format("{}: holds parts of an earlier version of {}, which has changed on the server since; delete "
                    "it, or name another file",
                    wish.cache.string(), wish.source.address.redacted())};
  }
  print_message("terrella: {}: the file has changed on the server, so its cache is begun anew\n",
                wish.source.address.redacted());
  for (const char* ending : {"", "-wal", "-shm"}) {
    std::error_code ignored;
    fs::remove(wish.cache.string() + ending, ignored);
  }
  return Done{};
}

/// Opens the cache; null if it cannot be written.
Result<std::shared_ptr<TileCache>> cache_of_tiff(const RemoteTiffWish& wish, const std::string& held_key,
                                                 const std::string& key) {
  if (key != held_key && version_in_key(held_key, wish.source.address)) {
    if (Status discarded = discard_old_version(wish); !discarded) return discarded.error();
  }
  auto cache =
      open_cache("terrella", wish.cache, range_cache_info(), key, wish.source.cache_size_mb, wish.on_cache_failed);
  if (cache) return *std::move(cache);
  if (!cache.error().cannot_write) return cache.error();
  say_without_cache(cache.error());
  return std::shared_ptr<TileCache>();
}

Result<std::shared_ptr<RemoteFile>> open_remote_file(const RemoteTiffWish& wish) {
  RemoteFileOptions options{.url = wish.source.address,
                            .headers = wish.source.remote.headers,
                            .http = wish.http,
                            .offline = wish.source.offline};
  options.go_on = may_wait;
  if (!wish.cache.empty()) {
    options.held_key = read_cache_source(wish.cache);
    options.open_cache = [&wish, held = options.held_key](const std::string& key) {
      return cache_of_tiff(wish, held, key);
    };
  }
  return RemoteFile::open(options);
}

/// Options for reading a TIFF, the same as for a local one.
RasterOptions reading_of(const RasterFile& raster, const NumberOptions& numbers) {
  RasterOptions reading;
  reading.heights = numbers.heights;
  if (numbers.heights) return reading;
  CutOptions cut;
  set_numbers(cut, numbers, holds_numbers(raster));
  set_numbers(reading, cut);
  return reading;
}

}  // namespace

bool leads_to_tiff(const Url& url, const std::vector<std::string>& headers, const HttpOptions& http) {
  if (is_tiff_address(url)) return true;
  if (is_pmtiles_address(url)) return false;
  const auto address = parse_address(url);
  if (!address || (address->scheme != "http" && address->scheme != "https") || names_its_kind(url)) return false;
  RangeReader reader(url, headers, http, may_wait);
  const auto head = reader.read({.offset = 0, .length = 8});
  return head && begins_as_tiff(as_text(*head));
}

Result<RemotePicture> open_remote_picture(const RemoteTiffWish& wish) {
  auto file = open_remote_file(wish);
  if (!file) return file.error();
  const auto raster = open_remote_raster(**file);
  if (!raster) return raster.error();
  return RemotePicture{*std::move(file), as_picture(*raster)};
}

Result<OpenedRemoteTiff> open_remote_tiff(const RemoteTiffWish& wish) {
  auto tiff = open_remote_picture(wish);
  if (!tiff) return tiff.error();
  const PictureFile& picture = tiff->picture;
  DirectOptions direct = direct_options(wish.source);
  auto placed = place_picture(picture, direct.place);
  if (!placed) return placed.error();
  if (!wish.source.body && placed->crs) direct.body = stated_body(*placed->crs);
  const bool placeless = !placed->projected;
  auto place = place_raster(*std::move(placed), picture, direct);
  if (!place) return place.error();
  if (!*place) {
    return Error{
        fmt::format("{}: nothing in it says where it lies (files beside it on the server are not read), and {}x{} "
                    "pixels are no whole planet (2:1); say it with --crs CRS and --bounds W,S,E,N",
                    tiff->file->name(), picture.width_px, picture.height_px)};
  }
  if (placeless) (*place)->remarks.push_back(taken_for_planet(tiff->file->name()));
  auto raster =
      RemoteTiff::make(tiff->file, picture.raster, (*place)->at, reading_of(*picture.raster, wish.source.numbers));
  if (!raster) return raster.error();
  return OpenedRemoteTiff{*std::move(tiff), *std::move(raster), **std::move(place), direct.body};
}

Status check_shows_at_once(const RemotePicture& tiff) {
  const std::string& where = tiff.file->name();
  const RasterHeader& header = tiff.picture.raster->header();
  if (!header.whole().has_blocks()) return no_blocks(*tiff.picture.raster);
  const RasterShape& coarsest = header.levels.front();
  std::vector<RasterLevel> levels;
  for (const RasterShape& level : header.levels) {
    levels.push_back({.width_px = level.width_px,
                      .height_px = level.height_px,
                      .block_width_px = static_cast<int>(level.block_width_px),
                      .block_height_px = static_cast<int>(level.block_height_px),
                      .to_crs = {}});
  }
  if (const auto far = far_levels(levels)) {
    const auto& [coarse, fine] = *far;
    return Error{fmt::format(
        "{0}: the next level over its {1}x{2} pixels has {3}x{4}, and views between the two would need thousands of "
        "tiles; put one with all overviews in its place (gdal_translate -of COG IN.tif OUT.tif), or cut it: terrella "
        "cut {0} -o OUT.gpkg",
        where, fine.width_px, fine.height_px, coarse.width_px, coarse.height_px)};
  }
  if (coarsest.width_px * coarsest.height_px <= kMostCoarsestPixels) return Done{};
  return Error{fmt::format(
      "{0}: its coarsest picture has {1}x{2} pixels, all of which a view of the whole would need (a file of overviews "
      "beside it is not read); put one with overviews in its place (gdal_translate -of COG IN.tif OUT.tif), or cut it: "
      "terrella cut {0} -o OUT.gpkg",
      where, coarsest.width_px, coarsest.height_px)};
}

Result<std::unique_ptr<TileSource>> tiles_of(OpenedRemoteTiff opened, const DirectOptions& direct) {
  if (Status shows = check_shows_at_once(opened.tiff); !shows) return shows.error();
  return direct_tiles(std::move(opened.raster), opened.place, direct, opened.tiff.file->name());
}

void set_raster(CutOptions& cut, const RemotePicture& tiff) {
  CutRaster raster{.key = tiff.file->cache_key(), .open = {}};
  raster.open = [tiff](const CrsPlace& place, const RasterOptions& reading) -> Result<std::unique_ptr<RasterSource>> {
    auto opened = RemoteTiff::make(tiff.file, tiff.picture.raster, place, reading);
    if (!opened) return opened.error();
    return waiting_raster(*std::move(opened), [] { return !StopSignals::came(); });
  };
  cut.images = {tiff.picture.path};
  cut.picture = tiff.picture;
  cut.raster = std::move(raster);
}

DirectOptions direct_options(const SourceOptions& options) {
  DirectOptions direct{.body = {}, .latitude = options.latitude, .place = options.place};
  if (options.body && options.body->name != earth().name) direct.body = options.body->name;
  return direct;
}

}  // namespace terrella
