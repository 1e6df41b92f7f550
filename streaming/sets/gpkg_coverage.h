#pragma once

#include <string>

#include "base/result.h"
#include "streaming/sqlite_reader.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Data type of a table of heights in gpkg_contents.
inline constexpr const char* kCoverageDataType = "2d-gridded-coverage";

/// Reads the meaning of the numbers in a tiled gridded coverage from its row of gpkg_2d_gridded_coverage_ancillary (OGC
/// 17-066r1, table 2). Refuses, with the reason, heights that are not in metres, that lie at the corners of pixels, or
/// of an unknown type. The error begins with `where`.
[[nodiscard]] Result<NumberInfo> read_coverage(SqliteReader& reader, const std::string& table,
                                               const std::string& where);

}  // namespace terrella
