#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Mark of sets that convert() wrote, and the key of its work folders.
inline constexpr const char* kConvertMark = "converted";

struct ConvertOptions {
  std::filesystem::path from;     ///< a folder, GeoPackage, MBTiles or PMTiles file; a cache too
  std::filesystem::path to;       ///< *.gpkg, *.mbtiles, *.pmtiles, else a folder
  bool force = false;             ///< replaces a tile set that cut() or convert() wrote
  bool geodetic_mbtiles = false;  ///< an MBTiles file `from` is geodetic, whatever it states
  /// Replaces the file, and is a TileLister; `from` is then its name alone.
  std::shared_ptr<TileSource> source = {};
  std::string mark = kConvertMark;  ///< mark of the output; with another one nothing is replaced
  /// Called with the tiles done and the total. Returning false stops the work; nothing is left behind. thread: the
  /// caller's
  std::function<bool(std::int64_t done, std::int64_t total)> progress{};
};

struct ConvertSummary {
  TileSetInfo info;        ///< description of the new set; its format is that of the first tile
  std::int64_t tiles = 0;  ///< squeezed tiles included
  std::int64_t bytes = 0;  ///< sum of these tiles
  std::int64_t blank = 0;  ///< empty tiles, which were left out
  int min_level = 0;       ///< coarsest level with a tile, as the new set counts levels
  int max_level = 0;       ///< finest such level
};

/// Writes a tile set in another format, without decoding a tile: each tile keeps its place and its bytes, the set its
/// name, attribution and bounds. Equal inputs give equal bytes. The output gets its name when it is complete. Memory
/// does not grow with the number of tiles. Fails if `to` exists without `force`, or if the format has no place for the
/// set: MBTiles and PMTiles take pictures in Web Mercator alone, MBTiles and folders one format of pictures. The error
/// names the input or output, and a cure. Blocks. thread: any
[[nodiscard]] Result<ConvertSummary> convert(const ConvertOptions& options);

}  // namespace terrella
