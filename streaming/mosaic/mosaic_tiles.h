#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/mosaic/mosaic_index.h"
#include "tiles/tile_source.h"

namespace terrella {

struct MosaicOptions {
  MosaicPixels pixels = MosaicPixels::as_stored;
  MosaicFigure figure{};
  std::string body{};  ///< TileSetInfo::body
  MosaicReading reading{};
  int tile_px = 256;
  int most_open = 32;                         ///< files that stay open
  int jobs = 0;                               ///< threads that read headers; 0: one for each core
  std::filesystem::path store{};              ///< file for headers and overview; empty: both are made again each time
  std::filesystem::path work_folder{};        ///< RasterOptions::work_folder
  std::function<void(int files)> left_out{};  ///< receives the number of files that were left out. thread: any
  /// Receives the reason for each file that is left out, also later, when pixels cannot be read. thread: any, one at a
  /// time
  std::function<void(const std::string& reason)> remark{};
};

/// Rasters of any coordinate system and resolution as one tile set (streaming/mosaic/README.md).
class MosaicTiles : public TileSource {
 public:
  [[nodiscard]] virtual MosaicFacts facts() const = 0;  ///< thread: any
  [[nodiscard]] virtual int times_opened() const = 0;   ///< files opened for their pixels so far. thread: any
};

/// Opens a folder, a list or a description (mosaic_list.h). Reads headers alone. The error names the input. Blocks.
/// thread: any
[[nodiscard]] Result<std::unique_ptr<MosaicTiles>> open_mosaic(const std::filesystem::path& path,
                                                               const MosaicOptions& options);
/// The same for a list of files; errors begin with `where`. Blocks. thread: any
[[nodiscard]] Result<std::unique_ptr<MosaicTiles>> open_mosaic(const MosaicList& list, const std::string& where,
                                                               const MosaicOptions& options);

}  // namespace terrella
