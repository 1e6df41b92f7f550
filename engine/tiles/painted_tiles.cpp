#include "tiles/painted_tiles.h"

#include <utility>

namespace terrella {
namespace {

class PaintedTiles : public TileSource {
 public:
  PaintedTiles(const TileGrid& grid, TilePainter paint) : paint_(std::move(paint)) { info_.grid = grid; }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside the grid"};
    EncodedTile tile;
    tile.make_picture = [paint = paint_, id] { return paint(id); };
    return tile;
  }

 private:
  TileSetInfo info_;
  TilePainter paint_;
};

}  // namespace

std::shared_ptr<TileSource> painted_tiles(const TileGrid& grid, TilePainter paint) {
  return std::make_shared<PaintedTiles>(grid, std::move(paint));
}

}  // namespace terrella
