#pragma once

#include <map>
#include <memory>
#include <string>

#include "apps/open_scene/open_remote_tiff.h"
#include "apps/open_scene/options/source_options.h"
#include "base/result.h"
#include "streaming/mosaic/mosaic_index.h"
#include "streaming/mosaic/mosaic_tiles.h"
#include "tiles/tile_source.h"

namespace terrella {

/// True if TILESET is a folder, a list or a description of rasters (streaming/mosaic/README.md). thread: any
[[nodiscard]] bool names_mosaic(const Url& tile_set);

/// Opens TILESET, which names many rasters, as one tile set. Headers and overview are kept in the cache folder, unless
/// --cache is off. Files that cannot be read are named on standard error. The error names the input. thread: any
[[nodiscard]] Result<std::unique_ptr<MosaicTiles>> open_many_rasters(const SourceOptions& options, MosaicPixels pixels);

/// Opens one raster file as heights in metres, the same way. A file that states no place is a whole planet from -180°
/// on, if it is 2:1 or has nodes on both poles. thread: any
[[nodiscard]] Result<std::unique_ptr<MosaicTiles>> open_height_raster(const SourceOptions& options);

/// Heights for the whole planet from heights for a part: 0 m beyond it, with an even slope at its edge. Returns
/// heights for the whole planet unchanged. thread: any
[[nodiscard]] std::shared_ptr<TileSource> with_level_ground(std::shared_ptr<TileSource> heights);

/// Number of rasters that were left out by the functions above, so far: a result without them is done in part. thread:
/// any
[[nodiscard]] int rasters_left_out();

/// Rasters that were opened in place, by the name that opened them (which may be secret), for facts about them.
struct OpenedRasters {
  std::map<std::string, RemotePicture> remote{};  ///< keeps the connection and the cache of each open
  std::map<std::string, MosaicFacts> many{};
};

}  // namespace terrella
