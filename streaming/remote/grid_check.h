#pragma once

#include <functional>
#include <optional>
#include <string>

#include "base/result.h"
#include "codecs/image.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// One tile, decoded; nothing if the server has none such. May be asked for tiles one step outside the grid. An error
/// means that it could not be asked for.
using FetchTileImage = std::function<Result<std::optional<Image>>(const TileId&)>;

struct GridCheck {
  enum class Verdict {
    fits,         ///< tiles look like their parents
    cannot_tell,  ///< too flat, too few tiles, or they look like neither
    flipped_rows,
    one_root,      ///< the set has one root tile of 360°, the grid says two of 180°
    two_roots,     ///< the reverse
    web_mercator,  ///< one root tile, and tiles where a geodetic set has none
  };
  Verdict verdict = Verdict::cannot_tell;
  std::string advice;  ///< what is likely and what to do; empty if it fits
};

/// Compares a tile with the two tiles under half of it, and looks which root tiles there are: at most eight tiles are
/// asked for. Says that something is wrong only where the tiles say so clearly: seas of one colour, and sets that hold
/// a part of the planet, tell nothing. thread: any
[[nodiscard]] Result<GridCheck> check_grid(const FetchTileImage& fetch, const TileGrid& grid);

}  // namespace terrella
