#include "apps/preload/preload_source.h"

#include <filesystem>
#include <utility>

#include "apps/open_scene/fetch_description.h"
#include "apps/open_scene/open_remote_tiff.h"
#include "apps/process/stop_signals.h"
#include "geo/body.h"
#include "streaming/numbers/sample_tiles.h"
#include "streaming/raster/raster_pixels.h"
#include "streaming/remote/describe_remote.h"
#include "streaming/remote_tiff/range_plan.h"
#include "streaming/sets/open_tile_set.h"
#include "streaming/warp/warp_source.h"

namespace terrella {
namespace {

Result<PreloadSource> open_remote(const Url& source, const RemoteOptions& remote, const HttpOptions& http) {
  auto set = fetch_description(source, remote, http);
  if (!set) return set.error();
  return remote_preload_source(*std::move(set), http);
}

Result<PreloadSource> open_on_disk(const Url& named, int jobs) {
  const std::string& source = named.with_secrets();
  auto tiles = open_stored_tile_set(source);
  if (!tiles) return tiles.error();
  // A cache cannot store a GeoPackage's scale and offset of single height tiles.
  if ((*tiles)->info().numbers) {
    return Error{source + ": its tiles are heights, which caches do not keep; copy the tile set itself"};
  }
  const std::shared_ptr<TileSource> shared = *std::move(tiles);
  std::error_code unknown;
  const std::filesystem::path whole = std::filesystem::weakly_canonical(source, unknown);
  PreloadSource opened{
      .set = {}, .cache_info = {}, .key = "file:" + (unknown ? source : whole.string()), .make_origin = {}};
  opened.set.info = opened.cache_info = shared->info();
  opened.make_origin = [shared, jobs](ReplyQueue& answers) { return disk_origin(shared, jobs, answers); };
  return opened;
}

/// The raster checks the parts that come.
struct PlannedTiff {
  OpenedRemoteTiff opened;
  std::shared_ptr<RemoteTiff> raster;
  WarpFigure figure;
  TileGrid grid;
  std::shared_ptr<const SpanList> spans;
};

Result<std::shared_ptr<const TilePlan>> plan_spans(PlannedTiff& tiff, const TilePlan& tiles) {
  const auto find = [&tiff](const TilePlan& plan) {
    return spans_of_tiles(*tiff.raster, tiff.figure, tiff.grid, plan, may_wait);
  };
  auto spans = find(tiles);
  // A viewer stretches numbers by these tiles, wherever it looks.
  if (spans && !colour_bands(tiff.opened.tiff.picture.raster->header()).in_colours()) {
    auto sampled = find(*plan_list(sampled_places(tiff.grid)));
    if (!sampled) return sampled.error();
    spans->merge(*sampled);
  }
  if (!spans) return spans.error();
  std::vector<TileId> ids;
  for (const auto& [id, span] : *spans) ids.push_back(id);
  tiff.spans = std::make_shared<const SpanList>(*std::move(spans));
  return std::shared_ptr<const TilePlan>(plan_list(std::move(ids)));
}

Result<PreloadSource> open_tiff(const Url& source, const RemoteOptions& remote, const HttpOptions& http,
                                const PreloadTiff& asked) {
  const RemoteTiffWish wish{.source = {.address = source, .remote = remote, .cache_size_mb = asked.cache_size_mb},
                            .http = http,
                            .cache = asked.cache};
  auto opened = open_remote_tiff(wish);
  if (!opened) return opened.error();
  const auto body = opened->body.empty() ? Result<Body>(earth()) : parse_body(opened->body);
  if (!body) return body.error();
  const WarpOptions warp{.figure = {body->ellipsoid, opened->place.latitude, opened->place.latitude}, .body = {}};
  const auto grid = warp_grid(opened->raster->info(), warp, source.redacted());
  if (!grid) return grid.error();
  PreloadSource planned{
      .set = {}, .cache_info = range_cache_info(), .key = opened->tiff.file->cache_key(), .make_origin = {}};
  planned.set.url = source;
  planned.set.info.grid = *grid;
  planned.set.info.body = opened->body;
  const std::shared_ptr<RemoteFile> file = opened->tiff.file;
  if (file->cache() != nullptr) planned.cache = file->cache()->tiles();
  const std::shared_ptr<RemoteTiff> raster = std::move(opened->raster);
  auto tiff = std::make_shared<PlannedTiff>(
      PlannedTiff{.opened = *std::move(opened), .raster = raster, .figure = warp.figure, .grid = *grid, .spans = {}});
  planned.plan_parts = [tiff](const TilePlan& tiles) { return plan_spans(*tiff, tiles); };
  planned.make_origin = [tiff, file, http](ReplyQueue& answers) {
    return range_origin(file->address(), tiff->raster, http, tiff->spans, answers);
  };
  return planned;
}

}  // namespace

PreloadSource remote_preload_source(RemoteTileSet set, const HttpOptions& http) {
  PreloadSource opened{.set = set, .cache_info = set.info, .key = source_key(set), .remote = true, .make_origin = {}};
  const auto limits = within_limits(http, set);
  opened.make_origin = [limits, set = std::move(set)](ReplyQueue& answers) {
    return network_origin(set, limits, answers);
  };
  return opened;
}

Result<PreloadSource> open_preload_source(const Url& source, const RemoteOptions& remote, const HttpOptions& http,
                                          const PreloadTiff& tiff) {
  if (is_remote(source) && leads_to_tiff(source, remote.headers, http)) return open_tiff(source, remote, http, tiff);
  return is_remote(source) ? open_remote(source, remote, http) : open_on_disk(source, http.connections_per_host);
}

}  // namespace terrella
