#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// NASA GIBS' document of all its layers has about 5 MB.
inline constexpr std::size_t kMaxCapabilitiesBytes = 32UL << 20;

/// Finds a layer's tiles in a WMTS capabilities document (OGC 07-057r7, version 1.0.0): by the layer's URL template,
/// else by GetTile with key-value pairs. The first linked matrix set that a TileGrid can describe is taken, or the one
/// asked for; JPEG before PNG. Entities of the document's own are not expanded and nothing is fetched. The error begins
/// with `where` and says what there is instead (layers, times), or why a matrix set cannot be described. thread: any
[[nodiscard]] Result<RemoteTileSet> parse_wmts_capabilities(std::string_view xml, const RemoteOptions& options,
                                                            const std::string& where);

}  // namespace terrella
