#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "streaming/raster/raster_source.h"
#include "streaming/warp/map/ground_map.h"
#include "streaming/warp/stored_blocks.h"
#include "streaming/warp/warp_plan.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Memory for decoded blocks of a raster, in addition to decoded tiles for drawing.
inline constexpr std::size_t kWarpDecodedBytes = 32UL << 20;

struct WarpOptions {
  WarpFigure figure;  ///< body and kinds of latitude
  std::string body;   ///< TileSetInfo::body of the result
  int tile_px = 256;  ///< [16, 4096]
  std::size_t decoded_bytes = kWarpDecodedBytes;
  std::optional<TileGrid> grid = {};  ///< default: warp_grid(); else `tile_px` does not count
};

/// Chooses the grid of the tiles of a raster. Its finest pixels are no larger than those in the middle of the raster,
/// in longitude and in latitude, and divide 360° evenly. The bounds are the raster's extent: poles inside and ±180° are
/// considered. At most two root tiles go round the planet. A raster in plate carrée whose pixels lie on such a grid
/// gets it, so that its pixels are copied. The error begins with `where`. thread: any
[[nodiscard]] Result<TileGrid> warp_grid(const RasterInfo& raster, const WarpOptions& options,
                                         const std::string& where);

/// Makes a geodetic tile set (warp_grid()) from a raster in any coordinate system that PROJ knows, local or remote.
/// Tiles are pictures, or numbers if the raster has RasterInfo::numbers. Workers make a tile from the blocks of the
/// overview that suits it. Each block is read or fetched once, however many tiles need it at a time. Places beyond the
/// raster, and places that its projection does not reach, are transparent or NaN.
///
/// State of a tile if one of its blocks is
///   failed:  failed; the tile is requested again.
///   broken, or of another size:  broken; coarser tiles are drawn there.
///   absent:  its ancestors replace it if each overview halves the one before; else that part is transparent. Absent if
///            all blocks under the tile are absent.
///   blank:   that part is transparent. Blank if all blocks under the tile are blank.
/// The reason names the block. A tile without a block under it, beside the raster, is transparent.
///
/// Fails if PROJ does not know the coordinate system, if the transform is not finite, or if no pixel has a place. The
/// error begins with `where`. thread: any; the tiles' as TileSource says
[[nodiscard]] Result<std::unique_ptr<TileSource>> warp_source(std::unique_ptr<RasterSource> raster,
                                                              const WarpOptions& options, const std::string& where);

/// Plans tiles for several threads at a time. thread: any
class TilePlanner {
 public:
  /// Fails as GroundMap::open() does.
  [[nodiscard]] static Result<std::shared_ptr<TilePlanner>> open(const RasterInfo& raster, const WarpFigure& figure,
                                                                 const TileGrid& grid, Overviews overviews,
                                                                 Detail detail = Detail::usual);
  [[nodiscard]] const WarpFrame& frame() const { return frame_; }
  /// Fails as GroundMaps::lend() does.
  [[nodiscard]] Result<WarpPlan, TileFailure> plan(const TileId& id);
  /// The pixel of the raster's finest level under a place; infinite if there is none (GroundMap::pixels()). Fails as
  /// plan() does.
  [[nodiscard]] Result<CrsPoint, TileFailure> pixel_at(const RowPlace& place);

 private:
  TilePlanner(const RasterInfo& raster, std::shared_ptr<GroundMaps> maps, const TileGrid& grid, Overviews overviews,
              Detail detail);

  const std::shared_ptr<GroundMaps> maps_;
  const TileGrid grid_;
  const WarpFrame frame_;
};

/// Makes the source of another time (TileSource::at_time()).
using SourceAtTime = std::function<Result<std::unique_ptr<TileSource>>(UtcTime time)>;

/// Makes a source of tiles in a given grid; `info` describes it. `at_time` is called while the source lives; empty: the
/// source has no times.
[[nodiscard]] std::unique_ptr<TileSource> make_warp_source(std::unique_ptr<RasterSource> raster,
                                                           std::shared_ptr<TilePlanner> planner, TileSetInfo info,
                                                           BlockNames names, std::size_t decoded_bytes,
                                                           SourceAtTime at_time = {});

}  // namespace terrella
