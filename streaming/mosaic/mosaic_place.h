#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"
#include "geo/body.h"
#include "streaming/mosaic/mosaic_file.h"
#include "streaming/mosaic/mosaic_list.h"
#include "streaming/warp/map/ground_map.h"

namespace terrella {

/// A rectangle of longitudes and row latitudes, degrees. west is in [-180, 180); east may exceed 180, by a turn at
/// most.
struct MosaicBox {
  double west = 0.0, south = 0.0, east = 0.0, north = 0.0;

  /// True if the boxes overlap in any turn. Boxes that only touch do not.
  [[nodiscard]] bool meets(const MosaicBox& other) const;
  /// Degrees² that two boxes share.
  [[nodiscard]] double shared_area(const MosaicBox& other) const;
  [[nodiscard]] double area() const { return (east - west) * (north - south); }
};

/// Body and latitudes of a mosaic's tiles.
struct MosaicFigure {
  Body body = earth();
  std::optional<LatitudeKind> latitude = {};  ///< counted by the rows; default: as the files state
  /// A file without a place is a whole planet from -180° on, if it is 2:1 or its pixels are nodes from pole to pole.
  bool may_be_planet = false;
};

/// A coordinate system that files of a mosaic share.
struct MosaicSystem {
  LatitudeKind latitude = LatitudeKind::graphic;
  GroundMap map;  ///< from places to coordinates: its "pixels" are units of the system
};

/// Place of a file.
struct MosaicPlace {
  CrsPlace at;
  MosaicBox box;
  LatitudeKind latitude = LatitudeKind::graphic;
  double pixel_units = 0.0;  ///< side of a pixel in units of the system
  double unit_m = 1.0;       ///< metres on the ground in such a unit, at the middle of the file
};

/// Places files one by one. Opens each coordinate system once, because PROJ takes milliseconds for that. thread: one at
/// a time
class MosaicPlacer {
 public:
  explicit MosaicPlacer(const MosaicFigure& figure) : figure_(figure) {}
  /// The error names the file, its statement and a cure. Blocks.
  [[nodiscard]] Result<MosaicPlace> place(const MosaicFile& file, const MosaicEntry& entry);

 private:
  [[nodiscard]] Result<MosaicPlace> place_at(const MosaicFile& file, const CrsPlace& at, LatitudeKind latitude);
  [[nodiscard]] Result<CrsPlace> read_place(const MosaicFile& file, const PlaceWords& words, LatitudeKind& latitude);

  const MosaicFigure figure_;
  std::map<std::string, MosaicSystem> systems_;
};

}  // namespace terrella
