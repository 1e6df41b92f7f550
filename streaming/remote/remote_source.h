#pragma once

#include <functional>
#include <memory>

#include "base/result.h"
#include "streaming/cache/tile_cache.h"
#include "streaming/http/http_fetcher.h"
#include "streaming/remote/remote_tile_set.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Opens the cache of a set at its time; null: none.
using OpenCache = std::function<Result<std::shared_ptr<TileCache>>(const RemoteTileSet& set)>;

/// Tiles behind a network, with the cache before them (engine/DESIGN.md, 8 to 11). Ways of a tile:
///   cached and fresh: read() returns the tile, or the reason why it is missing, without a request;
///   cached and expired: fetch() asks with its validators; unchanged (304) or unreachable, the cached tile serves;
///   not cached: fetch() asks, and the answer is stored: a tile that decodes, or an absent or blank one, each with a
///   life of its own; failures for now and broken tiles are not stored.
/// Without a cache (nullptr) everything is fetched. A cache that cannot be read counts as empty for that tile: the
/// network still serves. The cache may be slow: two threads of the source call it, never the network thread. The
/// destructor waits for these threads, never for a server. An answer may release the last owner of the source.
///
/// Tiles of another time (TileSource::at_time()) come from a source of their own, with the cache that `open_cache`
/// opens and connections of its own. The server's limits in `options` hold for each source. thread: any
[[nodiscard]] std::unique_ptr<TileSource> make_remote_source(RemoteTileSet set, std::shared_ptr<TileCache> cache,
                                                             const HttpOptions& options, OpenCache open_cache = {});

}  // namespace terrella
