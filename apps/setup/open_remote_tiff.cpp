#include "apps/setup/open_remote_tiff.h"

#include <fmt/format.h>

#include <cassert>
#include <system_error>
#include <utility>

#include "apps/setup/console.h"
#include "apps/setup/open_cache.h"
#include "apps/setup/stop_signals.h"
#include "streaming/cache/cache_report.h"
#include "streaming/georeference/figure.h"
#include "streaming/remote/describe_remote.h"
#include "streaming/remote/remote_pmtiles.h"
#include "streaming/remote/web_address.h"
#include "streaming/remote_tiff/waiting_raster.h"
#include "streaming/tiff_open.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

/// Deletes the cache of an earlier version, or refuses to.
Status discard_old_version(const RemoteTiffWish& wish) {
  if (!wish.may_replace_cache) {
    return Error{
        fmt::format("{}: holds parts of an earlier version of {}, which has changed on the server since; delete "
                    "it, or name another file",
                    wish.cache.string(), wish.url.redacted())};
  }
  print_message("terrella: {}: the file has changed on the server, so its cache is begun anew\n", wish.url.redacted());
  for (const char* ending : {"", "-wal", "-shm"}) {
    std::error_code ignored;
    fs::remove(wish.cache.string() + ending, ignored);
  }
  return Done{};
}

/// Opens the cache; null if it cannot be written.
Result<std::shared_ptr<TileCache>> cache_of_tiff(const RemoteTiffWish& wish, const std::string& held_key,
                                                 const std::string& key) {
  if (key != held_key && version_in_key(held_key, wish.url)) {
    if (Status discarded = discard_old_version(wish); !discarded) return discarded.error();
  }
  auto cache = open_cache("terrella", wish.cache, range_cache_info(), key, wish.cache_size_mb);
  if (cache) return *std::move(cache);
  if (!cache.error().cannot_write) return cache.error();
  say_without_cache(cache.error());
  return std::shared_ptr<TileCache>();
}

Result<std::shared_ptr<RemoteFile>> open_remote_file(const RemoteTiffWish& wish) {
  RemoteFileOptions options{.url = wish.url, .headers = wish.headers, .http = wish.http, .offline = wish.offline};
  options.go_on = [] { return !StopSignals::came(); };
  if (!wish.cache.empty()) {
    options.held_key = read_cache_source(wish.cache);
    options.open_cache = [&wish, held = options.held_key](const std::string& key) {
      return cache_of_tiff(wish, held, key);
    };
  }
  return RemoteFile::open(options);
}

}  // namespace

bool leads_to_tiff(const Url& url, const std::vector<std::string>& headers, const HttpOptions& http) {
  if (is_tiff_address(url)) return true;
  if (is_pmtiles_address(url)) return false;
  const auto address = parse_address(url);
  if (!address || (address->scheme != "http" && address->scheme != "https") || names_its_kind(url)) return false;
  RangeReader reader(url, headers, http, [] { return !StopSignals::came(); });
  const auto head = reader.read({.offset = 0, .length = 8});
  return head && begins_as_tiff({reinterpret_cast<const char*>(head->data()), head->size()});
}

Result<OpenedRemoteTiff> open_remote_tiff(const RemoteTiffWish& wish) {
  auto file = open_remote_file(wish);
  if (!file) return file.error();
  auto pyramid = read_remote_pyramid(**file);
  if (!pyramid) return pyramid.error();
  const TiffPicture& whole = pyramid->whole().part.picture;
  const PictureFile picture{(*file)->name(), whole.width_px, whole.height_px, (*file)->fetching()};
  auto placed = place_picture(picture, wish.direct.place);
  if (!placed) return placed.error();
  DirectOptions direct = wish.direct;
  // "--body mars", after a space
  if (wish.any_body) direct.body = placed->crs ? std::string(body_option(*placed->crs)) : std::string();
  if (const std::size_t name = direct.body.rfind(' '); name != std::string::npos) direct.body.erase(0, name + 1);
  auto place = place_raster(*std::move(placed), picture, direct);
  if (!place) return place.error();
  if (!*place) {
    return Error{
        fmt::format("{}: nothing says where it lies, and {}x{} pixels are no whole planet (2:1); say it with "
                    "--crs CRS and --bounds W,S,E,N",
                    (*file)->name(), picture.width_px, picture.height_px)};
  }
  RasterOptions reading;
  reading.heights = wish.heights;
  auto raster = RemoteTiff::make(*file, *std::move(pyramid), (*place)->at, reading);
  if (!raster) return raster.error();
  return OpenedRemoteTiff{*std::move(file), *std::move(raster), picture, **std::move(place), direct.body};
}

Result<std::unique_ptr<TileSource>> tiles_of(OpenedRemoteTiff opened, const DirectOptions& direct) {
  const std::string where = opened.file->name();
  const RasterInfo& info = opened.raster->info();
  if (!shows_at_once(info)) {
    return Error{fmt::format(
        "{0}: its coarsest picture has {1}x{2} pixels, all of which a view of the whole would need; put one with "
        "overviews in its place (gdal_translate -of COG IN.tif OUT.tif), or cut it: terrella cut {0} -o OUT.gpkg",
        where, info.levels.front().width_px, info.levels.front().height_px)};
  }
  return direct_tiles(std::move(opened.raster), opened.place, direct, where);
}

CutRaster cut_raster(OpenedRemoteTiff opened) {
  CutRaster cut{.picture = opened.picture, .key = opened.file->cache_key(), .open = {}};
  // std::function needs a function that can be copied.
  cut.open = [shared = std::make_shared<OpenedRemoteTiff>(std::move(opened))](
                 const CrsPlace&, const RasterOptions&) -> Result<std::unique_ptr<RasterSource>> {
    assert(shared->raster);
    return waiting_raster(std::move(shared->raster), [] { return !StopSignals::came(); });
  };
  return cut;
}

DirectOptions direct_options(const SceneOptions& options) {
  DirectOptions direct{.body = {}, .latitude = options.latitude, .place = options.place};
  if (options.body && options.body->name != earth().name) direct.body = options.body->name;
  return direct;
}

}  // namespace terrella
