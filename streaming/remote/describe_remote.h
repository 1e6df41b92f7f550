#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// Fetches a document (http, https or file) of at most HttpOptions::max_response_bytes, with "Name: value" headers.
using FetchDocument =
    std::function<Result<std::vector<std::byte>>(const Url& url, const std::vector<std::string>& headers)>;

/// True if TILESET is one of those that describe_remote() reads rather than open_tile_set(): an address of any scheme,
/// a URL template, or a file that ends in .json or .xml (but for tileset.json and tilemapresource.xml, which describe
/// the directory they are in). Looks at the text alone. thread: any
[[nodiscard]] bool is_remote(const Url& tile_set);

/// Finds out where the tiles of a set are: a URL template; the address of a WMTS capabilities document, of a
/// tilemapresource.xml or of a JSON source description; or such a file on disk. What `options` say wins over what a
/// description says. A document from the network may not point to files, and headers are not sent to another scheme,
/// host or port than they were given for. Fetches at most two documents. thread: any
[[nodiscard]] Result<RemoteTileSet> describe_remote(const Url& tile_set, const RemoteOptions& options,
                                                    const FetchDocument& fetch);

}  // namespace terrella
