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

/// True if describe_remote() reads this TILESET, rather than open_tile_set(): an address of any scheme, a URL template,
/// or a file that ends in .json, .xml or .wms. Exceptions are tileset.json and tilemapresource.xml, which describe
/// their directory. Looks at the text only. thread: any
[[nodiscard]] bool is_remote(const Url& tile_set);

/// True if the text names the kind of its set: a URL template, WMTS, WMS, TMS or JSON. thread: any
[[nodiscard]] bool names_its_kind(const Url& tile_set);

/// Finds the addresses of a set's tiles. `tile_set` is a URL template, or the address or file of a WMTS or WMS
/// capabilities document, a GetMap request, a tilemapresource.xml, a GDAL_WMS or a JSON source description. `options`
/// override a description. A document from the network may not point to files. Headers are only sent to the scheme,
/// host and port for which they were given. Fetches at most two documents. thread: any
[[nodiscard]] Result<RemoteTileSet> describe_remote(const Url& tile_set, const RemoteOptions& options,
                                                    const FetchDocument& fetch);

}  // namespace terrella
