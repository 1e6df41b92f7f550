#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/http/range_reader.h"
#include "streaming/pmtiles/pmtiles_index.h"
#include "streaming/url.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Added to a grid's column and row to get the server's, for sets whose corner is not (-180°, 90°).
struct TileShift {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  std::int64_t turn_columns = 0;  ///< columns of 360°, by which the server's columns wrap; 0: no wrapping
  std::int64_t south_rows = 0;    ///< rows of the server, counted by {-y} from the last; 0: those of the grid
};

/// One file on a server that holds all tiles of a set (PMTiles).
struct TileFile {
  std::shared_ptr<PmtilesIndex> index;
  FileVersion version;  ///< the version that the index belongs to
};

/// Addresses of a set's tiles on the network. A value; causes no requests.
struct RemoteTileSet {
  TileSetInfo info{};
  /// Template with {z}, {x}, {y} (rows from the north) or {-y} (from the south), and {s} (one of `subdomains`). {row}
  /// and {col} are other names of {y} and {x}. {z} may stand for `level_names`. {q} is Bing's quadkey of all three.
  /// {bbox} are the tile's corners in the units of the grid's reference system, as WMS wants them.
  /// {time} is info.time as the service writes it; {time:FORMAT} is info.instant by strftime's codes.
  Url url{};
  bool northing_first = false;  ///< in {bbox}
  std::vector<std::string> subdomains{};
  std::vector<std::string> level_names{};           ///< by level, if they are not numbers (WMTS matrix identifiers)
  std::vector<TileShift> shifts{};                  ///< by level; empty: none
  std::vector<std::string> headers{};               ///< "Name: value"; may be secret: not in messages, not in the cache
  std::optional<std::chrono::seconds> tile_life{};  ///< for replies without an expiry; none: 7 days
  std::optional<std::chrono::seconds> missing_life{};  ///< none: 1 day
  std::optional<TileFile> file{};                      ///< set: the tiles are ranges of the file at `url`
  std::string refuse_bulk{};                           ///< reason why `preload` is forbidden; empty: allowed
  std::vector<int> missing_statuses{};  ///< HTTP statuses that also mean "no tile here", besides 204, 404 and 410
  bool exception_is_missing = false;    ///< an exception of the server as XML means "no tile here"
  std::optional<std::chrono::seconds> timeout{};  ///< longest time of one request; none: the program's
  int connections = 0;                            ///< most connections at once; 0: the program's
};

/// Address of one tile of the grid. A tile always goes to the same sub-domain. thread: any
[[nodiscard]] Url tile_url(const RemoteTileSet& set, const TileId& id);

/// Address as a cache may store it: without fragment, user and password, and without values of query parameters named
/// like key, token or signature. Other values stay, because they may select the tiles. thread: any
[[nodiscard]] std::string without_secrets(const Url& url);

/// Key that distinguishes this set's cache from others: address template at its time without secrets, sub-domains,
/// level names and shifts; no headers. thread: any
[[nodiscard]] std::string source_key(const RemoteTileSet& set);

}  // namespace terrella
