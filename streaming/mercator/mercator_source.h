#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "tiles/tile_source.h"

namespace terrella {

/// Memory for decoded tiles of a set in Web Mercator, beside what is decoded of it for drawing.
inline constexpr std::size_t kMercatorDecodedBytes = 32UL << 20;

/// Makes a geodetic tile set (geodetic_grid_of() in mercator_grid.h) of one whose grid is in Web Mercator, behind a
/// network or not. A tile is made of one to three stored ones and those around them that its filter reaches, each read
/// or fetched once however many tiles are made of it, by workers. Beyond ±85.05° tiles are transparent: the layer below
/// shows, or the globe's plain colour.
///
/// What becomes of a tile if a stored one that it is made of is
///   failed:  it failed too, and is asked for again;
///   broken, or of another size:  it is broken: coarser tiles stand there;
///   absent:  the stored one's ancestors stand in; without any it is transparent there. If all under it are, it is
///            absent itself;
///   blank:   transparent there; blank if all under it are.
/// The reason names the stored tile.
///
/// A source whose grid is not in Web Mercator is given back as it is. The error, for heights and bounds beyond the end
/// of Web Mercator, begins with `where`. thread: any; the tiles' as TileSource says
[[nodiscard]] Result<std::unique_ptr<TileSource>> as_geodetic(std::unique_ptr<TileSource> stored,
                                                              const std::string& where);

}  // namespace terrella
