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
