#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <vector>

#include "tiles/tile_source.h"

namespace terrella::test {

/// A colour of the planet at a place, degrees; each channel in [0, 255].
struct PlaceColor {
  double red = 0.0, green = 0.0, blue = 0.0;
};
using Planet = std::function<PlaceColor(double lat_deg, double lon_deg)>;

/// A tile of EPSG:3857's web pyramid as a tiler would make it: each pixel the mean of 4 × 4 places in it. Its formulas
/// are those of the sphere, lat = 2 atan(e^y) - 90°, and not the library's.
[[nodiscard]] Image mercator_tile(const Planet& planet, int tile_px, int level, std::int64_t x, std::int64_t y);

/// A set in Web Mercator, painted as it is read; what it lacks is settable. Counts the reads of each tile.
class MercatorPlanet : public TileSource {
 public:
  MercatorPlanet(Planet planet, int tile_px, int max_level);

  [[nodiscard]] const TileSetInfo& info() const override { return info_; }
  [[nodiscard]] Result<EncodedTile, TileFailure> read(const TileId& id) override;

  TileSetInfo& change() { return info_; }
  void note_missing(const TileId& id, MissingKind kind) { missing_[id] = kind; }
  void give(const TileId& id, Image picture) { given_[id] = std::move(picture); }
  [[nodiscard]] std::map<TileId, int> reads();

 private:
  const Planet planet_;
  TileSetInfo info_;
  std::map<TileId, MissingKind> missing_;
  std::map<TileId, Image> given_;
  std::mutex mutex_;  ///< guards what follows
  std::map<TileId, int> reads_;
};

}  // namespace terrella::test
