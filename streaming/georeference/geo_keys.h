#pragma once

#include <string>

#include "base/result.h"
#include "streaming/georeference/geo_tags.h"

namespace terrella {

/// Content of the GeoKeys of a TIFF.
struct GeoKeys {
  std::string crs;    ///< text for Crs::open(); empty if the keys name no system
  std::string title;  ///< name used in the file, for messages; may be empty
  bool pixel_is_point = false;
};

/// Reads the GeoKey directory with libgeotiff. The error names keys that are damaged, missing, unknown or
/// contradictory. Accepts any bytes. thread: any
[[nodiscard]] Result<GeoKeys> read_geo_keys(const GeoTags& tags);

}  // namespace terrella
