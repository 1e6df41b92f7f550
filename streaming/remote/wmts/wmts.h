#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// Finds a layer's tiles in a WMTS capabilities document (OGC 07-057r7, version 1.0.0). Uses the layer's URL template,
/// else GetTile with key-value pairs. Takes the requested matrix set, or the first linked one that a TileGrid can
/// describe; prefers JPEG to PNG. Does not expand entities of the document, and fetches nothing. The error begins with
/// `where`. It lists the choices (layers, times), or says why a matrix set cannot be described. thread: any
[[nodiscard]] Result<RemoteTileSet> parse_wmts_capabilities(std::string_view xml, const RemoteOptions& options,
                                                            const std::string& where);

}  // namespace terrella
