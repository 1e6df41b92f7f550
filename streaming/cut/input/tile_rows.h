#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/result.h"
#include "geo/coordinates.h"
#include "streaming/cut/input/row_reader.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Rows of the finest level of a tile set, as one picture.
struct TileRowsInput {
  std::unique_ptr<RowReader> rows;
  GeoRect bounds;  ///< the set's bounds, widened to whole pixels; east < west if they cross ±180°
};

/// Reads the finest level of a geodetic tile set of pictures or heights: the pixels inside its bounds, one row of tiles
/// at a time, made by `jobs` threads (0: one for each core). Holds one row of tiles: 3 bytes for each pixel of JPEG
/// sets, else 4; see tile_side_for_rows(). Missing tiles are transparent or NaN. With `numbers`, heights are converted
/// to tiles' numbers of that meaning: number = (metres - offset) / scale. Fails for sets that are not equirectangular
/// or have no local tiles, and for heights that are stored as pictures. The error of a row begins with `where`. thread:
/// any
[[nodiscard]] Result<TileRowsInput> open_tile_rows(std::unique_ptr<TileSource> tiles, int jobs,
                                                   const std::optional<NumberInfo>& numbers, const std::string& where);

/// Side of the tiles of which a row is held in at most 24 MiB, for a picture of that width: 256 px, or less for wide
/// pictures. thread: any
[[nodiscard]] int tile_side_for_rows(std::int64_t width_px);

}  // namespace terrella
