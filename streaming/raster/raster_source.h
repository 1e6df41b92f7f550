#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "streaming/georeference/georeference.h"
#include "tiles/tile_source.h"

namespace terrella {

/// One level of a raster: the raster itself or an overview. Blocks begin at the north-west pixel. Blocks at the right
/// and lower edges may reach beyond the level; the part beyond is not used.
struct RasterLevel {
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  int block_width_px = 256;
  int block_height_px = 256;
  Affine to_crs;  ///< pixels of this level to coordinates of RasterInfo::crs; pixel-is-area
};

/// Description of a raster in any coordinate reference system.
struct RasterInfo {
  std::string name;
  std::string attribution;
  std::string crs;                         ///< text for Crs::open()
  std::vector<RasterLevel> levels;         ///< the coarsest first; never empty. TileId::level is the index
  bool opaque = false;                     ///< every pixel inside a level has data
  bool by_rows = false;                    ///< blocks of a level are read from the top, row by row
  std::optional<NumberInfo> numbers = {};  ///< set: blocks are numbers; none: blocks are pictures
};

/// Pixels of a raster, read by blocks: a tiled TIFF with its overviews, a tile pyramid in a projected system, a decoded
/// picture. streaming/warp makes a geodetic tile set from it. info() is thread: any; read() is thread: worker, several
/// at once.
class RasterSource {
 public:
  virtual ~RasterSource() = default;
  [[nodiscard]] virtual const RasterInfo& info() const = 0;
  /// Reads a block: level, column and row of blocks. The answer is encoded bytes, or a function that makes the picture
  /// (EncodedTile::make_picture) or the numbers (EncodedTile::make_numbers). A block smaller than its level's block
  /// size is allowed at the right and lower edges only. MissingKind as for TileSource::read().
  [[nodiscard]] virtual Result<EncodedTile, TileFailure> read(const TileId& block) = 0;
  /// Returns the value of a pixel of the finest level, scale and offset applied. Failures as for
  /// TileSource::value_at(). thread: worker
  [[nodiscard]] virtual Result<double, TileFailure> value_at(std::int64_t column, std::int64_t row);
  /// Returns the object that fetches blocks for which read() returns `remote`; null if all blocks are local. Lives as
  /// long as the source.
  [[nodiscard]] virtual RemoteTiles* remote() { return nullptr; }
};

}  // namespace terrella
