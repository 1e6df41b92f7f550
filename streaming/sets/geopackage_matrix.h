#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/sets/geopackage_pyramid.h"

namespace terrella {

/// A row of gpkg_tile_matrix with numbers checked for range.
struct TileMatrix {
  std::int64_t zoom = 0;
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  int tile_px = 0;
  double span_deg = 0.0;  ///< size of a tile in both directions
};

/// A row of gpkg_tile_matrix_set or of gpkg_contents, degrees.
struct Extent {
  double west = 0.0, south = 0.0, east = 0.0, north = 0.0;
};

/// A tile table, and the unit of its reference system in degrees.
struct MatrixTable {
  std::string name;
  double unit_deg = 1.0;
};

/// Reads the tile matrices of a table, finest first. They must have square tiles of one size, each matrix must fill the
/// extent, and each span must be the finest times a power of two. Other tables are refused with the reason. The error
/// begins with `where`.
[[nodiscard]] Result<std::vector<TileMatrix>> read_matrices(SqliteReader& reader, const MatrixTable& table,
                                                            const Extent& extent, const std::string& where);

/// Sets the level of each matrix and the root span, so that level = zoom if that gives a sensible root. Sets root span,
/// tile size and level range of `info.grid`; its projection gives the origin. Leaves out matrices whose corner is no
/// whole number of tiles from the origin.
[[nodiscard]] Status place_on_grid(const std::vector<TileMatrix>& matrices, const Extent& extent,
                                   GeoPackageTiles& tiles, const std::string& where);

/// Like place_on_grid() for a known grid: finds the matrix of each level by the span of a tile.
[[nodiscard]] Status match_grid(const std::vector<TileMatrix>& matrices, const Extent& extent, GeoPackageTiles& tiles,
                                const std::string& where);

}  // namespace terrella
