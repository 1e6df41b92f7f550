#pragma once

#include <memory>
#include <string>

#include "tiles/height_tile.h"
#include "tiles/tile_source.h"

namespace terrella {

/// A tile set that is known to contain heights. open_tile_set() opens both the files of `terrella cut --elevation` and
/// the tiled gridded coverages of other programs. Copies share the tiles. thread: any
class ElevationSource {
 public:
  /// Checks and wraps a tile set. Errors begin with `name`, a path. Refuses tiles that are pictures. Refuses bounds
  /// that do not contain `covered` (by default the whole planet) to within half a pixel of the finest level. Reads the
  /// first local tile and refuses a kind or size that differs from the set's description.
  [[nodiscard]] static Result<ElevationSource> open(std::shared_ptr<TileSource> tiles, const std::string& name,
                                                    const GeoRect& covered = GeoRect{});

  [[nodiscard]] const TileGrid& grid() const { return tiles_->info().grid; }
  [[nodiscard]] const std::shared_ptr<TileSource>& tiles() const { return tiles_; }
  /// Reads and decodes a local tile. Fails as TileSource::read() does, or with `broken` if the tile cannot be decoded.
  [[nodiscard]] Result<HeightTile, TileFailure> read(const TileId& id) const;
  [[nodiscard]] Result<HeightTile, TileFailure> decode(const TileId& id, const EncodedTile& tile) const;

 private:
  explicit ElevationSource(std::shared_ptr<TileSource> tiles) : tiles_(std::move(tiles)) {}
  [[nodiscard]] Status try_first_tile(const std::string& name) const;

  std::shared_ptr<TileSource> tiles_;
};

}  // namespace terrella
