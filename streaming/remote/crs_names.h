#pragma once

#include <string>
#include <string_view>

#include "base/result.h"
#include "tiles/tile_grid.h"

namespace terrella {

/// A reference system of longitude and latitude in degrees.
struct GeographicCrs {
  bool latitude_first = false;  ///< by its definition; writers differ
  std::string body;             ///< a preset's name
  LatitudeKind latitude = LatitudeKind::graphic;
};

/// Reads the name of a reference system as a URN, a URL, or AUTHORITY:CODE: EPSG:4326, CRS84, and the geographic ones
/// of the Moon, Mars and other bodies by the IAU's codes (NAIF number · 100 and 0, 1 or 2; of those of 2015, 1 counts
/// planetographic latitudes, 2 planetocentric ones) or Esri's (104903 and 104905). The error is the reason why another
/// cannot be shown: Web Mercator by name. thread: any
[[nodiscard]] Result<GeographicCrs> parse_crs(std::string_view name);

/// True for the names that Web Mercator goes by, written as parse_crs() reads them. thread: any
[[nodiscard]] bool is_web_mercator(std::string_view name);

}  // namespace terrella
