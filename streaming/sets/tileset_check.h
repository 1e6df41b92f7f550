#pragma once

#include <string>

#include "base/result.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// The least root span, degrees. With it a column at level 24 still fits in 43 bits.
inline constexpr double kMinRootSpanDeg = 1e-3;
inline constexpr double kMaxRootSpanDeg = 1e4;
inline constexpr int kMinTilePx = 16;
inline constexpr int kMaxTilePx = 4096;
/// A tile at the end of Web Mercator may be made of fourteen stored ones at once: then of 112 MiB.
inline constexpr int kMaxMercatorTilePx = 1024;

/// Checks the ranges that TileGrid states, for a grid that was read from outside. The error is `where`, the field's
/// name in tileset.json, its value and what it may be. thread: any
[[nodiscard]] Status check_grid(const TileGrid& grid, const std::string& where);

}  // namespace terrella
