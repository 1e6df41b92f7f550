#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/result.h"
#include "streaming/http/http_fetcher.h"
#include "streaming/preload/tile_origin.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// What `preload` reads from: a remote set, or one on disk.
struct PreloadSource {
  RemoteTileSet set;  ///< of a set on disk only `info`
  std::string key;    ///< what tells its cache from others'
  bool remote = false;
  std::function<std::unique_ptr<TileOrigin>(ReplyQueue&)> make_origin;
};

/// Finds out what SOURCE is; a remote set's description is fetched. The error names SOURCE. thread: main
[[nodiscard]] Result<PreloadSource> open_preload_source(const Url& source, const RemoteOptions& remote,
                                                        const HttpOptions& http);

/// Fetches one document and waits for it. thread: any
[[nodiscard]] Result<std::vector<std::byte>> fetch_document(const HttpOptions& http, const Url& url,
                                                            const std::vector<std::string>& headers);

}  // namespace terrella
