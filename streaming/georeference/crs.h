#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/georeference.h"

struct pj_ctx;
struct PJconsts;

namespace terrella {

struct FreeProjContext {
  void operator()(pj_ctx* context) const;
};
struct FreeProj {
  void operator()(PJconsts* object) const;
};
using ProjContext = std::unique_ptr<pj_ctx, FreeProjContext>;
using ProjHandle = std::unique_ptr<PJconsts, FreeProj>;

/// Makes a PROJ context that prints nothing and contacts no server. Use it from one thread at a time.
[[nodiscard]] ProjContext make_proj_context();

/// Properties of a coordinate reference system.
struct CrsFacts {
  std::string name;
  std::string code;        ///< code, for example "EPSG:32633"; empty if unknown
  bool geographic = true;  ///< longitudes and latitudes; false: projected
  std::string method;      ///< name of the projection
  std::optional<double> central_meridian_deg;
  double a_m = 0.0;  ///< radii of the body's ellipsoid
  double b_m = 0.0;
  double unit_deg = 1.0;  ///< unit of the axes of a geographic system
  double unit_m = 1.0;    ///< unit of the axes of a projected system
  bool centric = false;   ///< the name of the system calls its latitudes planetocentric
};

/// Returns a file's WKT text on one line; "" if the text is not WKT. Other texts that Crs::open() accepts could name
/// files on this machine.
[[nodiscard]] std::string wkt_only(std::string text);

/// Conversion between a system's own longitudes and latitudes and degrees.
struct OwnDegrees {
  double unit_deg = 1.0;
  double prime_meridian_deg = 0.0;
  bool west_positive = false;

  [[nodiscard]] CrsPoint of(CrsPoint own) const {
    return {(west_positive ? -own.x : own.x) * unit_deg + prime_meridian_deg, own.y * unit_deg};
  }
  [[nodiscard]] CrsPoint from(CrsPoint degrees) const {
    const double east = (degrees.x - prime_meridian_deg) / unit_deg;
    return {west_positive ? -east : east, degrees.y / unit_deg};
  }
};

/// A horizontal coordinate reference system, as known to PROJ. Move-only. thread: one at a time
class Crs {
 public:
  /// Opens any text that PROJ accepts: EPSG:4326, PROJ strings, WKT 1 and 2. The error contains no file name.
  [[nodiscard]] static Result<Crs> open(const std::string& text);
  [[nodiscard]] const CrsFacts& facts() const { return facts_; }
  /// Text for gdalwarp of the system of longitudes and latitudes returned by places(): EPSG:4326 or a PROJ string.
  [[nodiscard]] std::string degrees_text() const;
  /// True if both systems give the same coordinates to every place; the order of the axes does not count.
  [[nodiscard]] bool is_same_as(const Crs& other) const;
  /// True if the ellipsoid is Earth's.
  [[nodiscard]] bool is_earth() const;
  /// Converts points of the system to longitudes (x, in any turn) and geodetic latitudes (y), in degrees. These are on
  /// WGS 84 for Earth, else on the system's own ellipsoid. Points without a place become infinite.
  [[nodiscard]] Result<std::vector<CrsPoint>> places(std::vector<CrsPoint> points) const;
  /// The inverse of places(): converts longitudes and latitudes in degrees to points of the system. Places without a
  /// point become infinite.
  [[nodiscard]] Result<std::vector<CrsPoint>> points(std::vector<CrsPoint> places) const;

 private:
  Crs() = default;
  [[nodiscard]] Status find_path() const;
  ProjContext context_;
  ProjHandle crs_;
  ProjHandle bound_;  ///< the system with its own shift to WGS 84, if it has one and its datum is not registered
  CrsFacts facts_;
  mutable ProjHandle path_;  ///< to degrees; found when first needed
  mutable OwnDegrees own_;
};

}  // namespace terrella
