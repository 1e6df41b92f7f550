#pragma once

#include <functional>
#include <optional>
#include <string>

#include "base/result.h"
#include "codecs/image.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// Fetches and decodes one tile; nothing if the server has no such tile. May be called for tiles one step outside the
/// grid. An error means that the request failed.
using FetchTileImage = std::function<Result<std::optional<Image>>(const TileId&)>;

struct GridCheck {
  enum class Verdict {
    fits,         ///< tiles look like their parents
    cannot_tell,  ///< too flat, too few tiles, or no similarity either way
    flipped_rows,
    one_root,      ///< the set has one root tile of 360°, the grid says two of 180°
    two_roots,     ///< the set has two root tiles of 180°, the grid says one of 360°
    web_mercator,  ///< one root tile, and tiles at places where a geodetic set has none
  };
  Verdict verdict = Verdict::cannot_tell;
  std::string advice;  ///< likely cause and cure; empty if the grid fits
};

/// Compares a tile with the two tiles under half of it, and checks which root tiles exist. Fetches at most eight tiles.
/// Reports a fault only if the tiles show it clearly; seas of one colour, and sets of a part of the planet, show
/// nothing. thread: any
[[nodiscard]] Result<GridCheck> find_mistaken_grid(const FetchTileImage& fetch, const TileGrid& grid);

}  // namespace terrella
