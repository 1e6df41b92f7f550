#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/raster/open_raster.h"
#include "streaming/raster/raster_source.h"
#include "streaming/raster/tiff_pyramid.h"
#include "streaming/remote_tiff/remote_file.h"

namespace terrella {

/// Reads the directories of a TIFF on a server: the picture, its overviews and masks. Fails for a picture in strips,
/// which cannot be read by parts. The error names the address and a cure. Waits for the network. thread: any
[[nodiscard]] Result<TiffPyramid> read_remote_pyramid(RemoteFile& file);

/// A tiled TIFF on a server as a raster whose blocks are fetched (RasterSource::remote()).
class RemoteTiff : public RasterSource {
 public:
  /// Makes a raster of a pyramid that read_remote_pyramid() read. Waits for the network if the picture needs a stretch
  /// that its metadata do not state. thread: any
  [[nodiscard]] static Result<std::unique_ptr<RemoteTiff>> make(std::shared_ptr<RemoteFile> file, TiffPyramid pyramid,
                                                                const CrsPlace& place, const RasterOptions& options);
  /// Looks up the bytes of a block. Waits for the network if its part of the table of tiles is not there. Fails if that
  /// cannot be had (failed) or is damaged (broken). The reason names the address. thread: any, one at a time
  [[nodiscard]] virtual Result<std::vector<ByteRange>, TileFailure> spans(const TileId& block) = 0;
};

/// True for an http or https address whose path ends in .tif or .tiff. thread: any
[[nodiscard]] bool is_tiff_address(const Url& tile_set);

}  // namespace terrella
