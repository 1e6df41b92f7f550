#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "streaming/cache/cache_report.h"
#include "streaming/mosaic/mosaic_tiles.h"
#include "streaming/url.h"
#include "tiles/tile_source.h"

namespace terrella {

/// One level of a tile set, as `terrella info` prints it.
struct LevelReport {
  int level = 0;
  double span_deg = 0.0;              ///< side of a tile
  std::int64_t places = 0;            ///< tiles of the grid within the bounds
  std::optional<std::int64_t> tiles;  ///< stored tiles, if they can be counted
};

/// A stored tile that cannot be decoded.
struct BadTile {
  TileId id;
  std::string why;
};

/// Result of reading every tile.
struct VerifyReport {
  std::int64_t good = 0, absent = 0, blank = 0, bad = 0;
  std::vector<BadTile> first_bad;  ///< at most kMaxBadTilesListed
};
inline constexpr std::size_t kMaxBadTilesListed = 1000;

struct TileSetReport {
  Url path;
  std::optional<std::uintmax_t> size_bytes;  ///< size of the file, or of all files in the directory
  TileSetInfo info;
  std::vector<LevelReport> levels;
  std::optional<CacheReport> cache;        ///< set for caches only
  std::optional<MosaicFacts> mosaic = {};  ///< set for many rasters as one tile set
  std::optional<VerifyReport> verified;
};

/// to_text() gives lines of text for people. to_json() gives one JSON object: the fields of tileset.json, and `path`,
/// `size_bytes`, `levels`, `cache`, `verified`.
[[nodiscard]] std::string to_text(const TileSetReport& report);
[[nodiscard]] std::string to_json(const TileSetReport& report);

}  // namespace terrella
