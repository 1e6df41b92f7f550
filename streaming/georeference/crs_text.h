#pragma once

#include <string>

#include "base/result.h"
#include "streaming/georeference/crs.h"

namespace terrella {

/// Returns the text for Crs::open() of a coordinate system that a document names: AUTHORITY:CODE, also as a URN or a
/// URL, CRS:84, "IAU2000:30100" (as IAU_2015), WKT, or a PROJ string. Refuses texts by which PROJ would open other
/// files: paths, "+init", grids of shifts. The error is the reason alone. thread: any
[[nodiscard]] Result<std::string> stated_crs(const std::string& text);

/// Name, code, method and central meridian of a system, for messages. `title` is used if the system has no name.
/// thread: any
[[nodiscard]] std::string crs_text(const CrsFacts& crs, const std::string& title);

/// Answers from PROJ's own definition: true if the system's first coordinate is the northing or the latitude. `text` is
/// one for Crs::open(). thread: any
[[nodiscard]] Result<bool> is_northing_first(const std::string& text);

/// Identity of a coordinate system, as a GeoPackage lists it.
struct CrsIdentity {
  std::string name;
  std::string authority = "NONE";  ///< authority of the code, for example "EPSG"
  int code = 0;                    ///< > 0; 0 if the system has no code
  std::string wkt = "undefined";   ///< WKT 1 in GDAL's dialect
};
[[nodiscard]] Result<CrsIdentity> identify_crs(const std::string& text);

}  // namespace terrella
