#pragma once

#include <memory>
#include <vector>

#include "streaming/mosaic/mosaic_sheet.h"
#include "streaming/mosaic/open_rasters.h"
#include "streaming/raster/raster_source.h"

namespace terrella {

/// Makes a raster of a sheet, for warp. Its blocks are means by area (area_mean.h) of each file's own overview that
/// suits the level, so files need neither equal overviews nor equal blocks. `files`, `sheet` and `rasters` must outlive
/// the raster. thread: any
[[nodiscard]] std::unique_ptr<RasterSource> make_sheet_raster(const std::vector<PlacedFile>& files,
                                                              const MosaicSheet& sheet, OpenRasters& rasters,
                                                              bool numbers);

/// Shape of a sheet as a raster. Pure. thread: any
[[nodiscard]] RasterInfo raster_info_of(const MosaicSheet& sheet, bool numbers);

/// Index in MosaicFile::sizes of the level that shows a file at 1/2^halvings: the coarsest that is no coarser, within
/// 5 %. Pure. thread: any
[[nodiscard]] int level_for(const MosaicFile& file, int halvings);

}  // namespace terrella
