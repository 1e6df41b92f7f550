#pragma once

#include <optional>

#include "base/result.h"
#include "streaming/raster/tiff_pyramid.h"

namespace terrella {

/// Values that replace those of the file's metadata.
struct CodingOptions {
  std::optional<double> nodata = {};
  std::optional<double> scale = {};
  std::optional<double> offset = {};
};

/// Chooses how the samples become colours, with a stretch where one is needed (tiff_stretch.h). Blocks. thread: any
[[nodiscard]] Result<ColourConverter> colours_of(const TiffPyramid& pyramid, const CodingOptions& options);

/// Chooses how the first band becomes numbers, with the metadata's scale and offset. Fails for a picture in colours.
/// The error names the file. thread: any
[[nodiscard]] Result<NumberCoding> numbers_of(const TiffPyramid& pyramid, const CodingOptions& options);

}  // namespace terrella
