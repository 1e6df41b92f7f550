#pragma once

#include <memory>
#include <set>
#include <span>
#include <string>

#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Equirectangular grid for drawing a set in Web Mercator. The root tile has the same span in longitude and the same
/// pixels, so texel columns are equal and only rows need resampling. Level numbers begin equally.
/// The grid has finer levels than the set, until a texel along the meridian is as short as Mercator's at the end of the
/// bounds (3 more levels for 85°). The rows of a level are equal in latitude, while Mercator's get finer towards the
/// poles. `mercator` must pass check_grid(). thread: any
[[nodiscard]] TileGrid geodetic_grid_of(const TileGrid& mercator);

/// Returns the stored tiles of which tiles of geodetic_grid_of(mercator) are made. thread: any
[[nodiscard]] Result<std::set<TileId>> stored_tiles_of(const TileGrid& mercator, std::span<const TileId> geodetic);

/// Returns the grid in which a set is drawn: its own, geodetic_grid_of(), or that of warp_grid() for a `projected` set.
/// The error is the reason alone. thread: any
[[nodiscard]] Result<TileGrid> drawn_grid_of(const TileSetInfo& stored);

/// Returns the stored tiles of which tiles of drawn_grid_of(stored) are made, for any set. thread: any
[[nodiscard]] Result<std::set<TileId>> stored_tiles_of(const TileSetInfo& stored, std::span<const TileId> drawn);

/// Makes a geodetic tile set (geodetic_grid_of()) from a set in Web Mercator, local or remote, pictures or heights. The
/// stored tiles are a raster in EPSG:3857 (warp_source.h describes missing tiles). Tiles beyond ±85.05° are
/// transparent: the layer below shows, or the globe's plain colour. The reason of a missing tile names the stored tile.
///
/// A set in a `projected` grid becomes one in the grid of warp_grid(). Returns a source in another projection
/// unchanged. Fails for bounds beyond the end of Web Mercator; the error begins with `where`. thread: any; the tiles'
/// as TileSource says
[[nodiscard]] Result<std::unique_ptr<TileSource>> as_geodetic(std::unique_ptr<TileSource> stored,
                                                              const std::string& where);

}  // namespace terrella
