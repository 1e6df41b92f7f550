#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/remote_tile_set.h"
#include "streaming/remote/wms/wms_address.h"

namespace terrella {

/// Makes a tile set of a layer in the capabilities of a WMS (OGC 01-068r3, version 1.1.1; OGC 06-042, version 1.3.0).
/// Each tile of a grid is a GetMap request for its rectangle, one tile in width and height. `said` holds the choices of
/// the address; those of `options` come first. Does not expand entities of the document, and fetches nothing. The error
/// begins with `where`. It lists the choices, or repeats the server's exception. thread: any
[[nodiscard]] Result<RemoteTileSet> parse_wms_capabilities(std::string_view xml, const WmsAddress& said,
                                                           const RemoteOptions& options, const std::string& where);

}  // namespace terrella
