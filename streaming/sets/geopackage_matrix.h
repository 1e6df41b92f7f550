#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/sets/geopackage_pyramid.h"

namespace terrella {

/// A row of gpkg_tile_matrix, as numbers that are in range.
struct TileMatrix {
  std::int64_t zoom = 0;
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  int tile_px = 0;
  double span_deg = 0.0;  ///< of a tile, both ways
};

/// A row of gpkg_tile_matrix_set or of gpkg_contents, degrees.
struct Extent {
  double west = 0.0, south = 0.0, east = 0.0, north = 0.0;
};

/// A tile table, and what a unit of its reference system counts in degrees.
struct MatrixTable {
  std::string name;
  double unit_deg = 1.0;
};

/// The tile matrices of a table, finest first: square tiles of one size, each matrix filling the extent, each span a
/// power of two times the finest. What else there may be is refused with the reason. The error begins with `where`.
[[nodiscard]] Result<std::vector<TileMatrix>> read_matrices(SqliteReader& reader, const MatrixTable& table,
                                                            const Extent& extent, const std::string& where);

/// The level of each matrix and the root span, so that level = zoom where that gives a sensible root; `info.grid` gets
/// root span, tile size and level range; its projection says where the origin is. Matrices whose corner is no whole
/// number of tiles from there are left out.
[[nodiscard]] Status place_on_grid(const std::vector<TileMatrix>& matrices, const Extent& extent,
                                   GeoPackageTiles& tiles, const std::string& where);

/// As place_on_grid() for a grid that is known: finds the matrix of each of its levels by the span of a tile.
[[nodiscard]] Status match_grid(const std::vector<TileMatrix>& matrices, const Extent& extent, GeoPackageTiles& tiles,
                                const std::string& where);

}  // namespace terrella
