#include "streaming/objects/vector/ways_to_degrees.h"

#include <cmath>

namespace terrella {
namespace {

struct DestroySystem {
  void operator()(OGRSpatialReferenceH system) const { gdal().OSRDestroySpatialReference(system); }
};
using System = std::unique_ptr<void, DestroySystem>;

/// A system with longitude before latitude; null if PROJ does not know it.
System system_of(const char* name) {
  System system(gdal().OSRNewSpatialReference(nullptr));
  if (gdal().OSRSetFromUserInput(system.get(), name) != OGRERR_NONE) return nullptr;
  gdal().OSRSetAxisMappingStrategy(system.get(), OAMS_TRADITIONAL_GIS_ORDER);
  return system;
}

System degrees_beside(OGRSpatialReferenceH system) {
  constexpr double kEarth_m = 6'378'137.0, kAlike_m = 10'000.0;  // no ellipsoid of the Earth differs by 2 km
  OGRErr unknown = OGRERR_NONE;
  if (std::abs(gdal().OSRGetSemiMajor(system, &unknown) - kEarth_m) <= kAlike_m || unknown != OGRERR_NONE) {
    return system_of(gdal().OSRIsCompound(system) != 0 ? "EPSG:4979" : "WGS84");
  }
  System degrees(gdal().OSRCloneGeogCS(system));
  if (degrees) gdal().OSRSetAxisMappingStrategy(degrees.get(), OAMS_TRADITIONAL_GIS_ORDER);
  return degrees;
}

}  // namespace

Transformation way_to_degrees(OGRSpatialReferenceH system) {
  const System degrees = degrees_beside(system);
  return Transformation(degrees ? gdal().OCTNewCoordinateTransformation(system, degrees.get()) : nullptr);
}

Transformation way_from_sea_level() {
  const GdalMessages messages;
  const System sea = system_of("EPSG:4326+5773"), ellipsoid = system_of("EPSG:4979");
  if (!sea || !ellipsoid) return {};
  Transformation way(gdal().OCTNewCoordinateTransformation(sea.get(), ellipsoid.get()));
  // Without the grid PROJ leaves heights as they are. The geoid is 17 m over the ellipsoid at 0, 0.
  double x = 0.0, y = 0.0, z = 0.0;
  if (!way || gdal().OCTTransform(way.get(), 1, &x, &y, &z) == 0 || std::abs(z) < 1.0) return {};
  return way;
}

}  // namespace terrella
