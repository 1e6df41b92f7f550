#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// A reference system of longitude and latitude in degrees.
struct GeographicCrs {
  bool latitude_first = false;  ///< by its definition; writers differ
  std::string body;             ///< name of a preset
  LatitudeKind latitude = LatitudeKind::graphic;
};

/// Parses the name of a reference system as a URN, a URL, or AUTHORITY:CODE. Knows EPSG:4326, CRS84, and the geographic
/// systems of the Moon, Mars and other bodies, by the codes of the IAU or Esri. IAU codes are the NAIF number · 100
/// plus 0, 1 or 2; in those of 2015, 1 means planetographic latitudes and 2 planetocentric ones. Esri's are 104903 and
/// 104905. The error gives the reason for other systems, and names Web Mercator. thread: any
[[nodiscard]] Result<GeographicCrs> parse_crs(std::string_view name);

/// URN of a body's system of longitude and latitude, longitude first, for parse_crs(). An empty body is the Earth.
/// Empty for bodies and latitudes without a registered system. thread: any
[[nodiscard]] std::string geographic_crs_urn(std::string_view body, LatitudeKind latitude);

/// True for the names of Web Mercator, in the notations of parse_crs(). thread: any
[[nodiscard]] bool is_web_mercator(std::string_view name);

}  // namespace terrella
