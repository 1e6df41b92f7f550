#pragma once

#include <memory>
#include <string>

#include "tiles/height_tile.h"
#include "tiles/tile_source.h"

namespace terrella {

/// A tile set of heights, known to be one: what open_tile_set() gives for what `terrella cut --elevation` writes and
/// for tiled gridded coverages of other programs. Values are shared by those who read. thread: any
class ElevationSource {
 public:
  /// `name` (a path) begins the error. Refused: tiles that are pictures; bounds that do not hold `covered`, the whole
  /// planet by default, half a pixel of the finest level aside; a first tile at hand that is of another kind than the
  /// set says, or of another size. Reads that one tile.
  [[nodiscard]] static Result<ElevationSource> open(std::shared_ptr<TileSource> tiles, const std::string& name,
                                                    const GeoRect& covered = GeoRect{});

  [[nodiscard]] const TileGrid& grid() const { return tiles_->info().grid; }
  [[nodiscard]] const std::shared_ptr<TileSource>& tiles() const { return tiles_; }
  /// A tile that is at hand. Absences as TileSource::read() tells them; broken if it cannot be decoded.
  [[nodiscard]] Result<HeightTile, TileFailure> read(const TileId& id) const;
  [[nodiscard]] Result<HeightTile, TileFailure> decode(const TileId& id, const EncodedTile& tile) const;

 private:
  explicit ElevationSource(std::shared_ptr<TileSource> tiles) : tiles_(std::move(tiles)) {}
  [[nodiscard]] Status try_first_tile(const std::string& name) const;

  std::shared_ptr<TileSource> tiles_;
};

}  // namespace terrella
