#pragma once

#include <array>
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
  std::string colour;  ///< "Red", "Green", "Blue" …, if it is not that of the band's place
};

/// Facts about the numbers in a TIFF that GDAL keeps in tags of its own, or in FILE.aux.xml.
struct TiffMetadata {
  std::optional<double> nodata;     ///< no data of all bands, by tag 42113, or by the first band in FILE.aux.xml
  std::vector<BandMetadata> bands;  ///< the first bands of the picture; further ones say nothing
  /// STATISTICS_MINIMUM and STATISTICS_MAXIMUM of all bands that have them.
  std::optional<double> least, most;

  /// The bands that the file names red, green and blue; none unless all three are there.
  [[nodiscard]] std::optional<std::array<std::size_t, 3>> colour_bands() const;
  /// Returns the metadata of a band, counted from 0.
  [[nodiscard]] BandMetadata band(std::size_t index) const {
    return index < bands.size() ? bands[index] : BandMetadata{};
  }
};

/// Reads the tags of the current directory. Tags of a wrong type and damaged XML count as missing, because the pixels
/// are readable without them. thread: that of the reader
[[nodiscard]] TiffMetadata read_metadata(TiffReader& reader);

/// Adds what FILE.aux.xml says of the bands. As in GDAL it wins over the tags, but for scale and offset. `xml`: its
/// text; damaged text changes nothing. thread: any
void add_side_metadata(const std::string& xml, TiffMetadata& metadata);

}  // namespace terrella
