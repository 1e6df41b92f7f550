#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/raster/open_raster.h"
#include "streaming/raster/raster_file.h"
#include "streaming/raster/raster_source.h"
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

/// A TIFF on a server as a raster whose blocks are fetched (RasterSource::remote()).
class RemoteTiff : public RasterSource {
 public:
  /// Makes a raster of one that open_remote_raster() opened. Fails for a picture in strips that has no blocks.
  /// Waits for the network if the picture needs a stretch that its metadata do not state. thread: any
  [[nodiscard]] static Result<std::unique_ptr<RemoteTiff>> make(std::shared_ptr<RemoteFile> file,
                                                                std::shared_ptr<const RasterFile> raster,
                                                                const CrsPlace& place, const RasterOptions& options);
  /// Looks up the bytes of a block. Waits for the network if its part of the table of tiles is not there. Fails if that
  /// part cannot be had (failed) or is damaged (broken). The reason names the address. thread: any, one at a time
  [[nodiscard]] virtual Result<std::vector<ByteRange>, TileFailure> spans(const TileId& block) = 0;
  /// Returns the check of a block's spans. It must not outlive the raster. thread: any
  [[nodiscard]] virtual SpanCheck check_of(const TileId& block) = 0;
};

}  // namespace terrella
