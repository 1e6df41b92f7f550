#pragma once

#include <optional>
#include <vector>

#include "base/result.h"
#include "streaming/raster/tiff_pyramid.h"

namespace terrella {

/// Reads the numbers of one band from a level: all of them, or those of at most 64 tiles or rows. No data is
/// NaN. Blocks. thread: any
[[nodiscard]] Result<std::vector<float>> sample_band(const TiffLevel& level, const NumberCoding& coding);

/// Finds the range of values that the picture shows from black to white. Returns nothing for pictures that need no
/// stretch: 8-bit samples, palettes, and 16-bit samples whose values use the upper half of the range. The range is that
/// of the metadata (STATISTICS_MINIMUM and _MAXIMUM), else the 2nd to the 98th percentile of the coarsest level, or of
/// a part of it. All colours share one range. Reads at most 64 tiles or rows. Blocks. thread: any
[[nodiscard]] Result<std::optional<Stretch>> find_stretch(const TiffPyramid& pyramid,
                                                          const std::optional<double>& nodata);

}  // namespace terrella
