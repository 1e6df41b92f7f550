#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "base/result.h"
#include "geo/body.h"
#include "streaming/georeference/georeference.h"
#include "streaming/warp/block.h"
#include "tiles/tile_source.h"

namespace terrella {

/// A flat map in a coordinate system: its north-west corner, and its pixels, which are square there.
struct FlatMap {
  std::string crs;    ///< text for Crs::open()
  double west = 0.0;  ///< outer corner of the first pixel, easting first, in units of `crs`
  double north = 0.0;
  double unit_per_px = 1.0;  ///< side of a pixel, in units of `crs`; > 0
  int width_px = 0;          ///< > 0
  int height_px = 0;         ///< > 0
  /// From pixels to coordinates of `crs`.
  [[nodiscard]] Affine to_crs() const { return {west, unit_per_px, 0.0, north, 0.0, -unit_per_px}; }
};

/// Makes the pixels of a flat map from the tiles of one set, block by block, as warp_source() makes tiles from a
/// raster: each pixel is the mean of the ground under it. Places that the map's projection does not reach, and places
/// without data, are transparent or NaN. thread: any, several at once
class FlatMapLayer {
 public:
  static constexpr int kBlock_px = 256;

  /// `tiles`: a set in a geodetic grid, local or remote. Fails if PROJ does not know the map's
  /// system, or if it is one of another body.
  [[nodiscard]] static Result<std::unique_ptr<FlatMapLayer>> open(std::shared_ptr<TileSource> tiles, const FlatMap& map,
                                                                  const Body& body);
  ~FlatMapLayer();
  FlatMapLayer(const FlatMapLayer&) = delete;
  FlatMapLayer& operator=(const FlatMapLayer&) = delete;

  [[nodiscard]] const TileSetInfo& info() const;
  /// Makes the block in a column and a row of blocks, kBlock_px a side: an image, or the numbers of the set as its
  /// tiles have them. Waits for a server while `may_wait` says so; it is asked ten times a second. `absent` or `blank`:
  /// the set has nothing there. Other failures name the tile. thread: worker; one call at a time for a block
  [[nodiscard]] Result<Block, TileFailure> block(std::int64_t column, std::int64_t row,
                                                 const std::function<bool()>& may_wait);

 private:
  struct Parts;
  explicit FlatMapLayer(std::unique_ptr<Parts> parts);
  const std::unique_ptr<Parts> parts_;
};

}  // namespace terrella
