#pragma once

#include <string>

#include "base/result.h"
#include "streaming/georeference/geo_tags.h"

namespace terrella {

/// What the GeoKeys of a TIFF say.
struct GeoKeys {
  std::string crs;    ///< a text for Crs::open(); empty: the keys name none
  std::string title;  ///< the file's own name for it, for messages; may be empty
  bool pixel_is_point = false;
};

/// Reads the GeoKey directory with libgeotiff. The error says which keys are damaged, missing, unknown, or contradict
/// each other. Takes any bytes. thread: any
[[nodiscard]] Result<GeoKeys> read_geo_keys(const GeoTags& tags);

}  // namespace terrella
