#pragma once

#include <string>

#include "base/result.h"

namespace terrella {

/// Refuses a KML document that makes GDAL's LIBKML driver crash instead of fail. `name`: GDAL's name of a KML file or,
/// for a KMZ file, of its ZIP folder, at most kMaxVectorUnpackedBytes long. The error is the fault alone, without the
/// file's name. GDAL must be loaded. Blocks. thread: any
[[nodiscard]] Status check_kml(const std::string& name, bool is_zip);

}  // namespace terrella
