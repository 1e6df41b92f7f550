#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// Makes a tile set of GDAL's XML description of a tile service. Sends no request. The error begins with `where`, names
/// the element and says what to change. thread: any
[[nodiscard]] Result<RemoteTileSet> parse_gdal_wms(std::string_view xml, const RemoteOptions& options,
                                                   const std::string& where);

}  // namespace terrella
