#pragma once

#include "base/result.h"
#include "streaming/http/range_reader.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// True for an http or https address whose path ends in .pmtiles. thread: any
[[nodiscard]] bool is_pmtiles_address(const Url& tile_set);

/// Describes a PMTiles archive on a server: reads its header, root directory, metadata and first tile through `reader`,
/// which is of `address`. Options may narrow the levels; the archive's own grid counts. The error begins with the
/// address. Waits for the network. thread: any
[[nodiscard]] Result<RemoteTileSet> describe_remote_pmtiles(const Url& address, const RemoteOptions& options,
                                                            RangeReader& reader);

}  // namespace terrella
