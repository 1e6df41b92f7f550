#pragma once

#include <vector>

#include "base/result.h"
#include "streaming/remote/remote_options.h"
#include "streaming/remote/remote_tile_set.h"

namespace terrella {

/// Places a URL template's tiles on the square that the options state (RemoteOptions::square): sets grid, square, body,
/// names of levels, and the numbers of rows that {-y} counts. The error is the reason alone. thread: any
[[nodiscard]] Status place_on_stated_square(const RemoteOptions& options, RemoteTileSet& set);

/// Shifts by which {-y} counts the rows of each level of a `projected` set. thread: any
[[nodiscard]] std::vector<TileShift> south_rows_of(const TileSetInfo& info);

}  // namespace terrella
