#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "base/result.h"
#include "streaming/cache/tile_cache.h"
#include "streaming/http/http_fetcher.h"
#include "streaming/preload/tile_origin.h"
#include "streaming/preload/tile_plan.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// Source of `preload`: a remote set, or a set on disk.
struct PreloadSource {
  RemoteTileSet set;       ///< only `info` for a set on disk
  TileSetInfo cache_info;  ///< description of the cache
  std::string key;         ///< identifies the source's cache
  bool remote = false;
  std::function<std::unique_ptr<TileOrigin>(ReplyQueue&)> make_origin;
  std::shared_ptr<TileCache> cache = {};  ///< the cache if it is open already, as that of a TIFF on a server is
  /// For a TIFF on a server: finds the parts of the file that a plan needs; call before make_origin(). Empty: the cache
  /// keeps the plan's tiles themselves.
  std::function<Result<std::shared_ptr<const TilePlan>>(const TilePlan& tiles)> plan_parts = {};
};

/// Options of a TIFF on a server, besides those of all sources.
struct PreloadTiff {
  std::filesystem::path cache;    ///< keeps the directories; empty: none
  std::size_t cache_size_mb = 0;  ///< 0: no limit
};

/// The source of a remote set whose description is known. thread: any
[[nodiscard]] PreloadSource remote_preload_source(RemoteTileSet set, const HttpOptions& http);

/// Opens SOURCE; fetches a remote set's description. The error names SOURCE. thread: main
[[nodiscard]] Result<PreloadSource> open_preload_source(const Url& source, const RemoteOptions& remote,
                                                        const HttpOptions& http, const PreloadTiff& tiff);

}  // namespace terrella
