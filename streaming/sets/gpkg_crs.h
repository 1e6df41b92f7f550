#pragma once

#include <cstdint>
#include <string>

#include "base/result.h"
#include "streaming/georeference/georeference.h"
#include "streaming/sqlite_reader.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// The reference system of a tile table.
struct GpkgCrs {
  std::string name;  ///< name for messages, for example "EPSG:4326"
  Projection projection = Projection::equirectangular;
  std::string text{};  ///< for Crs::open(); empty for EPSG:4326 and the tiles of Web Mercator
  std::string body{};  ///< value of --body; empty for EPSG:4326 and the tiles of Web Mercator, as they say nothing more
  LatitudeKind latitude = LatitudeKind::graphic;  ///< counted by degrees
};

/// Reads a system from gpkg_spatial_ref_sys: by its organization and code, else by its definition (WKT 1, or WKT 2 in
/// `definition_12_063`). It counts as degrees if PROJ gives the corners of `extent`, in its units, the same numbers as
/// longitudes and latitudes. Pictures in EPSG:3857 are in Web Mercator; all others are `projected`. The error is the
/// reason alone and says what to do. thread: the connection's
[[nodiscard]] Result<GpkgCrs> read_gpkg_crs(SqliteReader& reader, std::int64_t srs_id, const CrsBounds& extent,
                                            bool is_coverage);

}  // namespace terrella
