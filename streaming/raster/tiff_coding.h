#pragma once

#include "base/result.h"
#include "streaming/numbers/coding_options.h"
#include "streaming/raster/tiff_pyramid.h"

namespace terrella {

/// Chooses how the samples become colours, with a stretch where one is needed (tiff_stretch.h). Blocks. thread: any
[[nodiscard]] Result<ColourConverter> colours_of(const TiffPyramid& pyramid, const CodingOptions& options);

/// Chooses how a band becomes numbers, with the metadata's scale and offset. Fails for a picture in colours of which no
/// band was chosen. The error names the file. thread: any
[[nodiscard]] Result<NumberCoding> numbers_of(const TiffPyramid& pyramid, const CodingOptions& options);

}  // namespace terrella
