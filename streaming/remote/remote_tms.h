#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// Describes the tiles beside a geodetic tilemapresource.xml that was fetched from `address`: {folder}/{x}/{y from the
/// south}. A query of the address goes with each tile. gdal2tiles does not say if there are one or two root tiles;
/// find_mistaken_grid() finds out. The error begins with `where`. thread: any
[[nodiscard]] Result<RemoteTileSet> parse_remote_tms(std::string_view xml, const Url& address,
                                                     const RemoteOptions& options, const std::string& where);

}  // namespace terrella
