#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/http/http_fetcher.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// Fetches the description of a remote set; the headers are in `remote`. The error names the address. thread: any
[[nodiscard]] Result<RemoteTileSet> fetch_description(const Url& source, const RemoteOptions& remote,
                                                      const HttpOptions& http);
/// Applies the limits that a set's description gives for its server. thread: any
[[nodiscard]] HttpOptions within_limits(HttpOptions http, const RemoteTileSet& set);

/// Fetches one document and waits for the answer. thread: any
[[nodiscard]] Result<std::vector<std::byte>> fetch_document(const HttpOptions& http, const Url& url,
                                                            const std::vector<std::string>& headers);

}  // namespace terrella
