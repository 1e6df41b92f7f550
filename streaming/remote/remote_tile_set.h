#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "streaming/url.h"
#include "tiles/tile_source.h"

namespace terrella {

/// What is added to a grid's column and row to have a server's, for sets whose corner is not (-180°, 90°).
struct TileShift {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  std::int64_t turn_columns = 0;  ///< columns of 360°, by which the server's are wrapped; 0: they are not
};

/// Where the tiles of a set are on the network. A value; nothing is asked for.
struct RemoteTileSet {
  TileSetInfo info{};
  /// With {z}, {x}, {y} (rows from the north) or {-y} (from the south), {s} (one of `subdomains`), and {row}, {col} as
  /// other names of {y} and {x}; {z} may stand for `level_names`.
  Url url{};
  std::vector<std::string> subdomains{};
  std::vector<std::string> level_names{};  ///< by level, where they are not the numbers (WMTS matrix identifiers)
  std::vector<TileShift> shifts{};         ///< by level; empty: none
  std::vector<std::string> headers{};      ///< "Name: value"; may be secret: not in messages, not in the cache
  std::optional<std::chrono::seconds> tile_life{};     ///< for replies that do not say when they expire; none: 7 days
  std::optional<std::chrono::seconds> absence_life{};  ///< none: 1 day
  std::string refuse_bulk{};                           ///< why `preload` may not be used on it; empty: it may
};

/// The address of one tile of the grid. The same tile always goes to the same sub-domain. thread: any
[[nodiscard]] Url tile_url(const RemoteTileSet& set, const TileId& id);

/// The address as a cache may keep it: without fragment, user and password, and of a query without the values of
/// parameters named like key, token or signature. Other values stay: they may say which tiles are meant. thread: any
[[nodiscard]] std::string without_secrets(const Url& url);

/// What tells this set's cache from others': address template without secrets, sub-domains, level names and
/// shifts; no headers. thread: any
[[nodiscard]] std::string source_key(const RemoteTileSet& set);

}  // namespace terrella
