#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "tiles/tile_source.h"

namespace terrella {

/// Memory for decoded stored tiles of a set in Web Mercator, in addition to decoded tiles for drawing.
inline constexpr std::size_t kMercatorDecodedBytes = 32UL << 20;

/// Makes a geodetic tile set (geodetic_grid_of() in mercator_grid.h) from a set in Web Mercator, local or remote.
/// Workers make a tile from one to three stored tiles and the neighbours that its filter reaches. Each stored tile is
/// read or fetched once, however many tiles need it. Tiles beyond ±85.05° are transparent: the layer below shows, or
/// the globe's plain colour.
///
/// State of a tile if one of its stored tiles is
///   failed:  failed; the tile is requested again.
///   broken, or of another size:  broken; coarser tiles are drawn there.
///   absent:  the stored tile's ancestors replace it; without any, that part is transparent. Absent if all stored tiles
///            under the tile are absent.
///   blank:   that part is transparent. Blank if all stored tiles under the tile are blank.
/// The reason names the stored tile.
///
/// Returns a source in another projection unchanged. Fails for heights, and for bounds beyond the end of Web Mercator;
/// the error begins with `where`. thread: any; the tiles' as TileSource says
[[nodiscard]] Result<std::unique_ptr<TileSource>> as_geodetic(std::unique_ptr<TileSource> stored,
                                                              const std::string& where);

}  // namespace terrella
