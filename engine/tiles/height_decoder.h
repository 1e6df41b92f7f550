#pragma once

#include "codecs/numbers.h"
#include "tiles/height_tile.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Largest absolute height that is accepted as ground of any body, metres.
inline constexpr double kMaxHeight_m = 1e6;

/// Decodes the numbers of a tile of side_px × side_px, without its scale and offset. The set's nodata and infinite
/// numbers become NaN. Broken, with the reason, if the picture is not a gray PNG of 16 bits (for floats: not a TIFF) or
/// has another size. A tile that is made of others makes its numbers. thread: worker
[[nodiscard]] Result<Numbers, TileFailure> decode_numbers(const EncodedTile& tile, const NumberInfo& info, int side_px);

/// Decodes the heights of a tile of side_px × side_px: metres = (number · tile's scale + tile's offset) · set's scale +
/// set's offset (OGC 17-066r1, clause 7.4). Numbers that are the set's nodata, NaN or infinite are unknown heights;
/// they are counted and filled by fill_gaps(). Broken as for decode_numbers(), and if it contains a height beyond
/// ±kMaxHeight_m. thread: any
[[nodiscard]] Result<HeightTile, TileFailure> decode_heights(const TileId& id, const EncodedTile& tile,
                                                             const NumberInfo& info, int side_px);

}  // namespace terrella
