#pragma once

#include "tiles/height_tile.h"
#include "tiles/tile_source.h"

namespace terrella {

/// A height beyond this is no height of any body's ground, metres.
inline constexpr double kMaxHeight_m = 1e6;

/// The heights of a tile of side_px a side: metres = (number · tile's scale + tile's offset) · set's scale + set's
/// offset (OGC 17-066r1, clause 7.4). What is the set's nodata, NaN or infinite is unknown: it is counted, and
/// stands as fill_gaps() has it. Broken,
/// with what is wrong: a picture that is no gray PNG of 16 bits (of floats: no TIFF), of another size, or with a
/// height beyond ±kMaxHeight_m. thread: any
[[nodiscard]] Result<HeightTile, TileFailure> decode_heights(const TileId& id, const EncodedTile& tile,
                                                             const ElevationInfo& info, int side_px);

}  // namespace terrella
