#pragma once

#include <filesystem>
#include <memory>

#include "base/result.h"
#include "streaming/numbers/coding_options.h"
#include "streaming/raster/raster_source.h"

namespace terrella {

/// Options for reading a raster.
struct CoarseChoice {
  CodingOptions coding{};
  bool numbers = false;  ///< values of a band, with scale and offset applied; plain pictures have none
};

/// Opens a small version of a large picture that takes at most about a second to read: a JPEG by scaled decoding, a
/// raster by some of its rows or tiles. Null for other pictures. `place` is that of the whole picture. Blocks.
/// thread: any
[[nodiscard]] Result<std::unique_ptr<RasterSource>> open_coarse_raster(const std::filesystem::path& path,
                                                                       const CrsPlace& place,
                                                                       const CoarseChoice& choice = {});

}  // namespace terrella
