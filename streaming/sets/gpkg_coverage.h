#pragma once

#include <string>

#include "base/result.h"
#include "streaming/sqlite_reader.h"
#include "tiles/tile_source.h"

namespace terrella {

/// What gpkg_contents calls a table of heights.
inline constexpr const char* kCoverageDataType = "2d-gridded-coverage";

/// What the numbers of a tiled gridded coverage mean, as its row of gpkg_2d_gridded_coverage_ancillary says (OGC
/// 17-066r1, table 2). Refused with the reason: heights that are not metres, at the corners of pixels, or of no
/// known type. The error begins with `where`.
[[nodiscard]] Result<ElevationInfo> read_coverage(SqliteReader& reader, const std::string& table,
                                                  const std::string& where);

}  // namespace terrella
