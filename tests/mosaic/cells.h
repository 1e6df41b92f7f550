#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "streaming/mosaic/mosaic_tiles.h"
#include "streaming/warp/block.h"
#include "tests/support/scratch_folder.h"

/// Small rasters with a place, and tiles of mosaics of them.
namespace terrella::test {

/// A raster of whole numbers in plate carrée, written without GDAL, because a test needs hundreds.
struct Cell {
  double west_deg = 0.0, north_deg = 0.0, pixel_deg = 0.0625;
  int width_px = 16, height_px = 16;
  std::string unit = {};  ///< as GDAL keeps it
};
/// Writes a TIFF of 16-bit numbers with sign; `value` has the column and the row.
void write_cell(const std::filesystem::path& path, const Cell& cell, const std::function<int(int, int)>& value);

/// Opens; a failure of the test if that fails.
[[nodiscard]] std::unique_ptr<MosaicTiles> must_open(const std::filesystem::path& path,
                                                     const MosaicOptions& options = {});
/// The pixels of a tile, which may have to be made first. A failure of the test if there are none.
[[nodiscard]] Block must_read(TileSource& tiles, const TileId& id);
/// All tiles of a level.
[[nodiscard]] std::vector<TileId> tiles_of(const TileGrid& grid, int level);

/// Largest difference of two blocks of one kind, and how many pixels only one of them has.
struct BlockDifference {
  double largest = 0.0;
  int one_only = 0;
  int shared = 0;  ///< pixels that both have
};
[[nodiscard]] BlockDifference difference(const Block& a, const Block& b);

}  // namespace terrella::test
