#pragma once

#include <filesystem>
#include <memory>

#include "base/result.h"
#include "streaming/raster/open_raster.h"

namespace terrella {

/// open_raster() for every picture that open_rows() reads: TIFF with its own levels and blocks; JPEG, PNG and WebP with
/// one level, decoded once into a store of blocks. Heights are read from TIFF and 16-bit gray PNG. Blocks. thread: any
[[nodiscard]] Result<std::unique_ptr<RasterSource>> open_picture_raster(const std::filesystem::path& path,
                                                                        const CrsPlace& place,
                                                                        const RasterOptions& options = {});

}  // namespace terrella
