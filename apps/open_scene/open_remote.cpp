#include "apps/open_scene/open_remote.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

#include "apps/open_scene/dated_files.h"
#include "apps/open_scene/fetch_description.h"
#include "apps/open_scene/open_cache.h"
#include "apps/open_scene/open_imagery.h"
#include "apps/open_scene/open_rasters.h"
#include "apps/open_scene/open_remote_tiff.h"
#include "apps/open_scene/options/place_options.h"
#include "apps/process/console.h"
#include "apps/process/stop_signals.h"
#include "base/hash_mix.h"
#include "codecs/image.h"
#include "streaming/cache/cache_report.h"
#include "streaming/cache/tile_cache.h"
#include "streaming/remote/grid_check.h"
#include "streaming/remote/remote_source.h"
#include "streaming/remote/url_template.h"
#include "streaming/sets/open_tile_set.h"
#include "streaming/warp/web_mercator.h"

namespace terrella {
namespace {

namespace fs = std::filesystem;

// Finest level of a URL template without --max-level. Most servers end earlier; their ancestors replace the missing
// tiles.
constexpr int kTemplateMaxLevel = 18;
constexpr std::size_t kMaxNameBytes = 60;

bool is_template(const SourceOptions& options) {
  return options.address.with_secrets().find("{z}") != std::string::npos;
}

/// Makes a file name from the address without secrets, and a hash of the rest. A new key or password does not make a
/// new source.
std::string cache_name(const SourceOptions& options) {
  std::string name;
  for (const char c : options.address.without_query().substr(0, kMaxNameBytes)) {
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '-';
  }
  const RemoteOptions& r = options.remote;
  std::string whole = fmt::format("{}|{}|{}|{}|{}|{}|{}", without_secrets(options.address), r.layer, r.matrix_set,
                                  r.style, r.time, r.root_span_deg.value_or(0.0), r.tile_px.value_or(0));
  if (options.projection == Projection::web_mercator) whole += "|web-mercator";
  if (!options.place.crs.empty()) {
    whole += "|" + options.place.crs + (options.place.bounds ? "|" + bounds_text(*options.place.bounds) : "");
  }
  return fmt::format("{}-{:016x}.gpkg", name, name_hash(whole));
}

Result<fs::path> cache_file(const SourceOptions& options) {
  if (!options.cache.empty()) return fs::path(options.cache);
  const auto folder = picture_cache_folder({});
  if (!folder) return folder.error();
  std::error_code failed;
  fs::create_directories(*folder, failed);
  if (failed) return Error{fmt::format("{}: cannot be made: {}", folder->string(), failed.message())};
  return *folder / cache_name(options);
}

/// The cache for one time of a set only: beside the file that --cache names, else in the user's cache folder.
Result<fs::path> dated_file(SourceOptions options, const std::string& time) {
  if (!options.cache.empty()) return file_of_time(options.cache, time);
  options.remote.time = time;
  return cache_file(options);
}

/// The cache of a set at a time. An existing file for that time only comes first, as preload writes it. Else the time
/// at which the set was opened, `opened`, has the plain file.
Result<fs::path> cache_file_at(const SourceOptions& options, const std::string& time, const std::string& opened) {
  auto dated = dated_file(options, time);
  std::error_code failed;
  if (!dated || time != opened || fs::exists(*dated, failed)) return dated;
  return cache_file(options);
}

/// Opens a TIFF on a server.
Result<std::shared_ptr<TileSource>> open_tiff(const SourceOptions& options, const HttpOptions& http) {
  RemoteTiffWish wish{.source = options, .http = http};
  if (options.cache != "off") {
    const auto file = cache_file(options);
    if (!file) say_without_cache(file.error());
    if (file) wish.cache = *file;
  }
  wish.may_replace_cache = options.cache.empty();
  wish.on_cache_failed = say_without_cache;
  auto opened = open_remote_tiff(wish);
  if (!opened) return opened.error();
  if (options.opened != nullptr) {
    options.opened->remote.insert_or_assign(options.address.with_secrets(), opened->tiff);
  }
  for (const std::string& remark : opened->place.remarks) print_message("terrella: {}\n", remark);
  DirectOptions direct = direct_options(options);
  direct.body = opened->body;
  auto tiles = tiles_of(*std::move(opened), direct);
  if (!tiles) return tiles.error();
  return std::shared_ptr<TileSource>(*std::move(tiles));
}

/// The time of a set that is opened offline: that of a URL template is known from its options; of other sets it is
/// --layer-time, empty if not given.
Result<std::string> time_of(const SourceOptions& options) {
  if (!is_template(options)) return options.remote.time;
  RemoteOptions remote = options.remote;
  if (!remote.max_level) remote.max_level = kTemplateMaxLevel;
  const auto set = template_tile_set(options.address, remote, true, "tile set");
  return set ? Result<std::string>(set->info.time) : set.error();
}

Result<std::shared_ptr<TileSource>> open_offline(const SourceOptions& named) {
  if (named.cache == "off") return Error{"--offline needs a cache, and --cache is off"};
  const auto time = time_of(named);
  if (!time) return time.error();
  SourceOptions options = named;
  options.remote.time = *time;
  const auto file = cache_file_at(options, *time, *time);
  if (!file) return file.error();
  std::error_code failed;
  const bool there = fs::exists(*file, failed);
  if (!options.cache.empty() && (!there || *file != options.cache)) {
    auto dated = open_dated_caches(options.cache, *time);
    if (!dated || *dated) return dated;
  }
  if (!there) {
    return Error{
        fmt::format("{}: nothing of it is in a cache ({} is not there); look at it or preload it once without "
                    "--offline",
                    options.address.redacted(), file->string())};
  }
  if (version_in_key(read_cache_source(*file), options.address)) return open_tiff(options, {});
  auto tiles = open_tile_set(*file);
  if (!tiles) return tiles.error();
  return std::shared_ptr<TileSource>(*std::move(tiles));
}

HttpOptions network_options() {
  HttpOptions http;
  http.attempts = 3;
  // A user may turn the globe this fast, but no server should see an attack.
  http.rate_per_host = 200.0;
  http.burst = 100.0;
  return http;
}

std::shared_ptr<TileCache> go_without(const Error& why) {
  say_without_cache(why);
  return nullptr;
}

/// Opens the cache of a set at its time; nullptr if the cache is off or not writable. Refuses a file of another kind.
/// `opened` is the time at which the set was opened.
Result<std::shared_ptr<TileCache>> cache_of(const SourceOptions& options, const RemoteTileSet& set,
                                            const std::string& opened) {
  if (options.cache == "off") return std::shared_ptr<TileCache>();
  const auto file = cache_file_at(options, set.info.time, opened);
  if (!file) return go_without(file.error());
  const auto open = [&](const fs::path& path) {
    return open_cache("terrella", path, set.info, source_key(set), options.cache_size_mb, say_without_cache);
  };
  auto cache = open(*file);
  if (!cache && !cache.error().cannot_write) {
    // The set was opened at another time when the file was made.
    const auto dated = dated_file(options, set.info.time);
    if (dated && *dated != *file) cache = open(*dated);
  }
  if (!cache && cache.error().cannot_write) return go_without(cache.error());
  if (!cache) return cache.error();
  return *std::move(cache);
}

bool knows_a_root(const std::shared_ptr<TileCache>& cache, const TileGrid& grid) {
  if (cache == nullptr) return false;
  const auto root = cache->peek({grid.min_level, 0, 0});
  return root && *root;
}

/// Compares a few tiles of a URL template before the first picture, because a template states no grid. A wrong grid is
/// reported instead of drawn. Sets drawn before are skipped: their cache has tiles.
Status check_template_grid(const RemoteTileSet& set, const HttpOptions& http) {
  const auto fetch = [&](const TileId& id) -> Result<std::optional<Image>> {
    const auto bytes = fetch_document(http, tile_url(set, id), set.headers);
    if (!bytes) return std::optional<Image>();
    auto image = decode_image(*bytes, DecodeLimits{});
    return image ? std::optional<Image>(*std::move(image)) : std::nullopt;
  };
  const auto check = find_mistaken_grid(fetch, set.info.grid);
  if (!check) return Done{};  // a failed fetch proves nothing
  if (check->verdict == GridCheck::Verdict::fits || check->verdict == GridCheck::Verdict::cannot_tell) return Done{};
  return Error{fmt::format("{}: {}", set.info.name, check->advice)};
}

Result<std::shared_ptr<TileSource>> open_online(const SourceOptions& options) {
  HttpOptions http = network_options();
  if (leads_to_tiff(options.address, options.remote.headers, http)) return open_tiff(options, http);
  RemoteOptions remote = options.remote;
  if (!remote.max_level && is_template(options)) remote.max_level = kTemplateMaxLevel;
  if (options.projection) remote.projection = options.projection;
  if (is_template(options) && !options.place.crs.empty()) {
    remote.square = StatedSquare{.crs = options.place.crs, .extent = options.place.bounds};
  }
  auto set = fetch_description(options.address, remote, http);
  if (!set) return set.error();
  SourceOptions named = options;
  if (is_template(options)) named.remote.time = set->info.time;
  http = within_limits(http, *set);
  const OpenCache open_cache = [options = std::move(named), opened = set->info.time](const RemoteTileSet& other) {
    return cache_of(options, other, opened);
  };
  auto cache = open_cache(*set);
  if (!cache) return cache.error();
  if (is_template(options) && !set->info.square && !knows_a_root(*cache, set->info.grid)) {
    if (const Status grid = check_template_grid(*set, http); !grid) return grid.error();
  }
  // The cache holds the tiles in the server's projection.
  auto tiles =
      as_geodetic(make_remote_source(*std::move(set), *std::move(cache), http, open_cache), options.address.redacted());
  if (!tiles) return tiles.error();
  return std::shared_ptr<TileSource>(*std::move(tiles));
}

}  // namespace

Result<fs::path> cache_file_of_set(SourceOptions options, const TileSetInfo& opened, const std::string& time) {
  if (is_template(options)) options.remote.time = opened.time;
  return cache_file_at(options, time, opened.time);
}

Result<std::shared_ptr<TileSource>> open_remote(const SourceOptions& options) {
  if (options.offline) return open_offline(options);
  const WaitLimit limit(options.timeout_s);
  auto opened = open_online(options);
  if (!opened) return Error{opened.error().message + WaitLimit::advice()};
  return opened;
}

}  // namespace terrella
