#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/georeference/affine.h"

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

/// A context of PROJ that prints nothing and asks no server. Used by one thread at a time.
[[nodiscard]] ProjContext make_proj_context();

/// What a coordinate reference system says of itself.
struct CrsFacts {
  std::string name;
  std::string code;        ///< "EPSG:32633"; empty: none
  bool geographic = true;  ///< longitudes and latitudes; else projected
  std::string method;      ///< of the projection
  std::optional<double> central_meridian_deg;
  double a_m = 0.0;  ///< radii of the body's figure
  double b_m = 0.0;
  double unit_deg = 1.0;  ///< of a geographic system's axes
  bool centric = false;   ///< its latitudes are called planetocentric
};

/// A system that a file gives as text, on one line; "" if the text is no WKT. Other texts that Crs::open() takes can
/// name files of this machine.
[[nodiscard]] std::string wkt_only(std::string text);

/// A horizontal coordinate reference system, as PROJ knows it. Move-only. thread: one at a time
class Crs {
 public:
  /// From any text that PROJ takes: EPSG:4326, PROJ strings, WKT 1 and 2. The error has no file's name.
  [[nodiscard]] static Result<Crs> open(const std::string& text);
  [[nodiscard]] const CrsFacts& facts() const { return facts_; }
  /// A text of the longitudes and latitudes that places() gives, for gdalwarp: EPSG:4326 or a PROJ string.
  [[nodiscard]] std::string degrees_text() const;
  /// True for a figure that is Earth's.
  [[nodiscard]] bool is_earth() const;
  /// Longitudes (x, as they come: any turn) and geodetic latitudes (y), in degrees, of points of the system: on WGS 84
  /// for Earth, else on the system's own figure. Points that have no place are infinite.
  [[nodiscard]] Result<std::vector<CrsPoint>> places(std::vector<CrsPoint> points) const;

 private:
  Crs() = default;
  ProjContext context_;
  ProjHandle crs_;
  CrsFacts facts_;
};

}  // namespace terrella
