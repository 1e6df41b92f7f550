#include "streaming/raster/open_raster.h"

#include "streaming/raster/tiff_raster.h"

namespace terrella {

Result<std::unique_ptr<RasterSource>> open_raster(const std::filesystem::path& path, const RasterPlace& place,
                                                  const RasterOptions& options) {
  return open_tiff_raster(path, place, options);
}

}  // namespace terrella
