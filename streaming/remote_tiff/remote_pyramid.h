#pragma once

#include <string>

#include "base/result.h"
#include "streaming/raster/tiff_pyramid.h"
#include "streaming/remote_tiff/remote_file.h"

namespace terrella {

/// True for an http or https address whose path ends in .tif or .tiff. thread: any
[[nodiscard]] bool is_tiff_address(const Url& tile_set);

/// Reads the directories of a TIFF on a server: the picture, its overviews and masks. Directories that cannot be read
/// are requested once more, and the cache keeps only those that can be. Levels in strips are read by blocks of strips
/// (make_strip_blocks()). The picture itself stays without blocks if its strips are too large, and
/// such overviews are left out. The error names the address and a cure. Waits for the network. thread: any
[[nodiscard]] Result<TiffPyramid> read_remote_pyramid(RemoteFile& file);

/// Returns the reason why parts of a picture in large strips are not fetched, and a cure. thread: any
[[nodiscard]] Error no_blocks(const std::string& name, const TiffPyramid& pyramid);

}  // namespace terrella
