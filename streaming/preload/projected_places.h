#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "base/result.h"
#include "geo/map_plane.h"
#include "streaming/georeference/crs.h"
#include "streaming/raster/raster_source.h"
#include "tiles/tile_range.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Places on the planet of the tiles of a `projected` set. thread: any
class ProjectedPlaces {
 public:
  /// The error is the reason alone.
  [[nodiscard]] static Result<std::shared_ptr<const ProjectedPlaces>> open(const TileSetInfo& info);

  /// The tiles that a level has.
  [[nodiscard]] TilePlaces places(int level) const;
  /// Returns rectangles that together hold these tiles. One or two for several tiles; up to 32 small ones for a
  /// single tile. Empty if the tiles lie nowhere on the planet.
  [[nodiscard]] std::vector<MapRect> rects(int level, const TileSpan& columns, const TileSpan& rows) const;
  /// Span of a tile, degrees, about.
  [[nodiscard]] double span_deg(int level) const;

 private:
  ProjectedPlaces(TileSetInfo info, Crs crs, std::vector<CrsPoint> poles);
  [[nodiscard]] const RasterLevel& level_of(int level) const;

  const TileSetInfo info_;
  const RasterInfo raster_;
  const Crs crs_;
  mutable std::mutex mutex_;     ///< guards crs_
  std::vector<CrsPoint> poles_;  ///< north, south; infinite if the system does not have it
};

}  // namespace terrella
