#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "streaming/cache/cache_report.h"
#include "streaming/url.h"
#include "tiles/tile_source.h"

namespace terrella {

/// One level of a tile set, as `terrella info` prints it.
struct LevelReport {
  int level = 0;
  double span_deg = 0.0;              ///< of a tile
  std::int64_t places = 0;            ///< tiles that the grid has within the bounds
  std::optional<std::int64_t> tiles;  ///< that are there, if they can be counted
};

/// A tile that is there and has no pixels.
struct BadTile {
  TileId id;
  std::string why;
};

/// What reading every tile showed.
struct VerifyReport {
  std::int64_t good = 0, absent = 0, blank = 0, bad = 0;
  std::vector<BadTile> first_bad;  ///< at most kMaxBadTilesListed
};
inline constexpr std::size_t kMaxBadTilesListed = 1000;

struct TileSetReport {
  Url path;
  std::optional<std::uintmax_t> size_bytes;  ///< of the file or of all files in the directory
  TileSetInfo info;
  std::vector<LevelReport> levels;
  std::optional<CacheReport> cache;  ///< if it is one
  std::optional<VerifyReport> verified;
};

/// For people: lines of text. For programs: one JSON object, the fields of tileset.json and `path`, `size_bytes`,
/// `levels`, `cache`, `verified`.
[[nodiscard]] std::string to_text(const TileSetReport& report);
[[nodiscard]] std::string to_json(const TileSetReport& report);

}  // namespace terrella
