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

/// Source of `preload`: a remote set, or a set on disk.
struct PreloadSource {
  RemoteTileSet set;  ///< only `info` for a set on disk
  std::string key;    ///< identifies the source's cache
  bool remote = false;
  std::function<std::unique_ptr<TileOrigin>(ReplyQueue&)> make_origin;
};

/// Opens SOURCE; fetches a remote set's description. The error names SOURCE. thread: main
[[nodiscard]] Result<PreloadSource> open_preload_source(const Url& source, const RemoteOptions& remote,
                                                        const HttpOptions& http);

/// Fetches the description of a remote set; the headers are in `remote`. The error names the address. thread: any
[[nodiscard]] Result<RemoteTileSet> fetch_description(const Url& source, const RemoteOptions& remote,
                                                      const HttpOptions& http);
/// Applies the limits that a set's description gives for its server. thread: any
[[nodiscard]] HttpOptions within_limits(HttpOptions http, const RemoteTileSet& set);

/// Fetches one document and waits for the answer. thread: any
[[nodiscard]] Result<std::vector<std::byte>> fetch_document(const HttpOptions& http, const Url& url,
                                                            const std::vector<std::string>& headers);

}  // namespace terrella
