#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/raster/open_raster.h"
#include "streaming/raster/tiff_pyramid.h"
#include "streaming/raster/tiff_tiles.h"

namespace terrella {

/// A TIFF as a raster, which also says where the bytes of its blocks are.
class TiffSource : public RasterSource {
 public:
  /// Looks up the bytes from which a block is decoded, masks included. Parts that the file does not store are left out.
  /// Blocks of a level in strips have none. The error does not name the file. thread: any, several at once
  [[nodiscard]] virtual Result<std::vector<ByteSpan>> spans(const TileId& block) = 0;
  /// Decodes one of the spans() of a block from its bytes; the error says why that fails. Samples that are stored
  /// without compression always decode. thread: any, several at once
  [[nodiscard]] virtual Status check(const TileId& block, const ByteSpan& span, std::span<const std::byte> bytes) = 0;
  /// The same raster, read from other bytes of the same file. All levels must be tiled. thread: any
  [[nodiscard]] virtual std::unique_ptr<TiffSource> over(const std::shared_ptr<const ByteFile>& file) const = 0;
};

/// Makes a raster from a pyramid; see open_raster(). `name` is for messages and RasterInfo::name. thread: any
[[nodiscard]] Result<std::unique_ptr<TiffSource>> make_tiff_source(TiffPyramid pyramid, const std::string& name,
                                                                   const CrsPlace& place, const RasterOptions& options);

}  // namespace terrella
