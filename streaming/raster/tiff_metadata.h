#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/raster/tiff_reader.h"

namespace terrella {

/// Facts about the numbers in a TIFF that GDAL keeps in tags of its own.
struct TiffMetadata {
  std::optional<double> nodata;  ///< the tag 42113
  std::string unit;              ///< the first band's unit
  double scale = 1.0;            ///< the first band's: value = number · scale + offset
  double offset = 0.0;
  /// STATISTICS_MINIMUM and STATISTICS_MAXIMUM of all bands that have them.
  std::optional<double> least, most;
};

/// Reads the tags of the current directory. Tags of a wrong type and damaged XML count as missing, because the pixels
/// are readable without them. thread: that of the reader
[[nodiscard]] TiffMetadata read_metadata(TiffReader& reader);

}  // namespace terrella
