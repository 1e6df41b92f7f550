#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/raster/tiff_reader.h"

namespace terrella {

/// The meaning of one band's numbers: value = number · scale + offset.
struct BandMetadata {
  std::string unit;
  std::string description;
  double scale = 1.0;
  double offset = 0.0;
};

/// Facts about the numbers in a TIFF that GDAL keeps in tags of its own.
struct TiffMetadata {
  std::optional<double> nodata;     ///< the tag 42113
  std::vector<BandMetadata> bands;  ///< the first bands of the picture; further ones say nothing
  /// STATISTICS_MINIMUM and STATISTICS_MAXIMUM of all bands that have them.
  std::optional<double> least, most;

  /// Returns the metadata of a band, counted from 0.
  [[nodiscard]] BandMetadata band(std::size_t index) const {
    return index < bands.size() ? bands[index] : BandMetadata{};
  }
};

/// Reads the tags of the current directory. Tags of a wrong type and damaged XML count as missing, because the pixels
/// are readable without them. thread: that of the reader
[[nodiscard]] TiffMetadata read_metadata(TiffReader& reader);

}  // namespace terrella
