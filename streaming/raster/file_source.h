#pragma once

#include <memory>
#include <vector>

#include "base/result.h"
#include "streaming/raster/open_raster.h"
#include "streaming/raster/raster_file.h"

namespace terrella {

/// A raster file as a source of blocks, which also says where the bytes of its blocks are.
class FileSource : public RasterSource {
 public:
  /// Looks up the bytes from which a block is decoded, masks included. Parts that the file does not store are left out.
  /// Blocks of a level that is read by rows have none. The error does not name the file. thread: any, several at once
  [[nodiscard]] virtual Result<std::vector<ByteSpan>> spans(const TileId& block) = 0;
  /// Decodes one of the spans() of a block; the error says why that fails. Samples that are stored without compression
  /// always decode. thread: any, several at once
  [[nodiscard]] virtual Status check(const TileId& block, const ByteSpan& span) = 0;
  /// The same raster, read from other bytes of the same file. All levels must have blocks. thread: any
  [[nodiscard]] virtual std::unique_ptr<FileSource> over(const std::shared_ptr<const ByteFile>& bytes) const = 0;
};

/// Makes a source of an open file; see open_raster(). thread: any
[[nodiscard]] Result<std::unique_ptr<FileSource>> make_file_source(std::shared_ptr<const RasterFile> file,
                                                                   const CrsPlace& place, const RasterOptions& options);

}  // namespace terrella
