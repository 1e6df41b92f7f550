#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/descriptor.h"
#include "tiles/tile_source.h"

namespace terrella {

/// A tile set or a raster under a name.
struct ServedSet {
  std::string name;  ///< in addresses: letters, digits and "._-"
  std::shared_ptr<TileSource> tiles;
  bool is_made = false;                            ///< tiles are made of a raster on request, which takes milliseconds
  std::shared_ptr<const Descriptor> archive = {};  ///< the whole set as one PMTiles file; null for other kinds

  [[nodiscard]] const TileSetInfo& info() const { return tiles->info(); }
};

/// Number of tiles in a level, counted as addresses count them.
struct MatrixSize {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
};
[[nodiscard]] MatrixSize matrix_size(const TileSetInfo& info, int level);  ///< thread: any

/// Zoom of level 0 in addresses: that of the web pyramid for Web Mercator, else 0. thread: any
[[nodiscard]] int first_zoom(const TileSetInfo& info);

/// Opens the sets, each named as SET or NAME=SET. A set without a name gets that of its file, with a number if the name
/// is taken. Tile sets keep their stored grid; rasters are opened as open_any_tiles() does. Sets on a server and
/// rasters of numbers are refused. The error names the set and a cure. thread: main
[[nodiscard]] Result<std::vector<ServedSet>> open_served_sets(const std::vector<std::string>& sets);

}  // namespace terrella
