#include "tiles/painted_tiles.h"

#include <utility>

#include "tiles/grid_ranges.h"

namespace terrella {
namespace {

class PaintedTiles : public TileSource {
 public:
  PaintedTiles(const TileGrid& grid, TilePainter paint)
      : paint_(std::move(paint)), has_tiles_(check_grid(grid, "grid").ok()) {
    info_.grid = grid;
  }
  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override {
    if (!has_tiles_ || !exists(info_.grid, id)) return TileFailure{MissingKind::absent, "outside the grid"};
    EncodedTile tile;
    tile.make_picture = [paint = paint_, id] { return paint(id); };
    return tile;
  }

 private:
  TileSetInfo info_;
  TilePainter paint_;
  bool has_tiles_;
};

}  // namespace

std::shared_ptr<TileSource> painted_tiles(const TileGrid& grid, TilePainter paint) {
  return paint ? std::make_shared<PaintedTiles>(grid, std::move(paint)) : nullptr;
}

}  // namespace terrella
