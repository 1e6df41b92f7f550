#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "geo/ellipsoid.h"
#include "streaming/georeference/crs.h"
#include "streaming/raster/raster_source.h"
#include "tiles/tile_grid.h"
#include "tiles/tile_source.h"

namespace terrella {

/// The latitudes of a tile grid and of a raster's coordinate system.
struct WarpFigure {
  Ellipsoid ellipsoid;                            ///< the body's
  LatitudeKind latitude = LatitudeKind::graphic;  ///< counted by rows of tiles
  std::optional<LatitudeKind> crs_latitude = {};  ///< counted by the raster's system; none: see GroundMap::open()
};

/// A place on the planet: longitude in any turn, and latitude of the kind that rows of tiles count, degrees.
struct RowPlace {
  double lon_deg = 0.0;
  double row_deg = 0.0;
};

/// The pixels of a raster's finest level that lie at places on the planet, by PROJ. Pixel coordinates begin at the
/// outer corner of the first pixel. thread: one at a time
class GroundMap {
 public:
  /// By default a system counts planetocentric latitudes if its name says so, or if its figure is a sphere while the
  /// body is flattened, except for Earth: there PROJ converts to WGS 84. Fails if PROJ does not know the system.
  [[nodiscard]] static Result<GroundMap> open(const RasterInfo& raster, const WarpFigure& figure);

  /// Returns the pixel coordinates of each place; infinite if the place is not on the raster's map. In a map with a
  /// turn() they continue beyond its ends, as the longitudes do.
  void pixels(std::span<const RowPlace> places, std::span<CrsPoint> out) const;
  /// The inverse; infinite if the pixel has no place.
  [[nodiscard]] std::vector<RowPlace> places(std::span<const CrsPoint> pixels) const;
  /// The vector, in pixels, after which the map repeats: 360° of longitude. Only cylindrical projections have one.
  [[nodiscard]] const std::optional<CrsPoint>& turn_px() const { return turn_px_; }

 private:
  GroundMap(Crs crs, const Affine& to_crs, const WarpFigure& figure);
  void find_turn();
  [[nodiscard]] double crs_latitude_deg(double row_deg) const;
  [[nodiscard]] CrsPoint pixel_of(CrsPoint point) const;

  Crs crs_;
  Affine to_crs_;
  double to_crs_tangent_ = 1.0;  ///< tan(latitude of the system) / tan(row latitude)
  double middle_lon_deg_ = 0.0;  ///< set with turn_px_: far from the ends of the map
  std::optional<CrsPoint> turn_px_;
};

/// Maps of one raster for several threads at a time: each uses its own, because PROJ's objects belong to one thread.
/// thread: any
class GroundMaps {
 public:
  /// Fails as GroundMap::open() does.
  [[nodiscard]] static Result<std::shared_ptr<GroundMaps>> open(const RasterInfo& raster, const WarpFigure& figure);
  /// Returns use(map). Fails if no map can be opened for a further thread: too many open files, not enough memory.
  template <class Use>
  [[nodiscard]] auto lend(const Use& use) -> Result<decltype(use(std::declval<const GroundMap&>())), TileFailure> {
    auto map = take();
    if (!map) return map.error();
    auto used = use(static_cast<const GroundMap&>(*map));
    put_back(*std::move(map));
    return used;
  }
  /// GroundMap::turn_px() of all of them.
  [[nodiscard]] const std::optional<CrsPoint>& turn_px() const { return turn_px_; }

 private:
  GroundMaps(RasterInfo raster, const WarpFigure& figure, GroundMap map);
  [[nodiscard]] Result<GroundMap, TileFailure> take();
  void put_back(GroundMap map);

  const RasterInfo raster_;
  const WarpFigure figure_;
  const std::optional<CrsPoint> turn_px_;
  std::mutex mutex_;             ///< guards idle_
  std::vector<GroundMap> idle_;  ///< maps that no thread uses
};

/// Pixel coordinates of one level as a function of another's: both have the same coordinate system.
[[nodiscard]] Affine level_from_finest(const RasterLevel& level, const RasterLevel& finest);

}  // namespace terrella
