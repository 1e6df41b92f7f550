#pragma once

#include <filesystem>
#include <memory>

#include "base/result.h"
#include "streaming/raster/open_raster.h"

namespace terrella {

/// open_raster() for a TIFF or BigTIFF. thread: any
[[nodiscard]] Result<std::unique_ptr<RasterSource>> open_tiff_raster(const std::filesystem::path& path,
                                                                     const RasterPlace& place,
                                                                     const RasterOptions& options);

}  // namespace terrella
