#pragma once

#include <string>

#include "base/result.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// Smallest root span, degrees. With it a column at level 24 still fits in 43 bits.
inline constexpr double kMinRootSpanDeg = 1e-3;
inline constexpr double kMaxRootSpanDeg = 1e4;
inline constexpr int kMinTilePx = 16;
inline constexpr int kMaxTilePx = 4096;
/// A tile at the end of Web Mercator may need fourteen stored tiles at once, which then take 112 MiB.
inline constexpr int kMaxMercatorTilePx = 1024;
/// Most tiles along a side of a level that a foreign document states.
inline constexpr double kMaxTilesASide = 0x1p40;

/// Checks the ranges stated by TileGrid, for a grid from outside. The error is `where`, the field's name in
/// tileset.json, its value and its allowed range. thread: any
[[nodiscard]] Status check_grid(const TileGrid& grid, const std::string& where);

}  // namespace terrella
