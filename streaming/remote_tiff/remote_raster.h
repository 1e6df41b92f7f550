#pragma once

#include <string>

#include "base/result.h"
#include "streaming/raster/raster_file.h"
#include "streaming/remote_tiff/remote_file.h"

namespace terrella {

/// True for an http or https address whose path ends in .tif or .tiff. thread: any
[[nodiscard]] bool is_tiff_address(const Url& tile_set);

/// Opens a raster on a server: its header, overviews and masks. Directories that cannot be read are requested once
/// more, and the cache keeps only those that can be. Levels in strips are read by blocks of strips
/// (RasterFile::in_strip_blocks()). The error names the address and a cure. Waits for the network. thread: any
[[nodiscard]] Result<std::shared_ptr<const RasterFile>> open_remote_raster(RemoteFile& file);

/// Returns the reason why parts of a picture in large strips are not fetched, and a cure. thread: any
[[nodiscard]] Error no_blocks(const RasterFile& file);

}  // namespace terrella
