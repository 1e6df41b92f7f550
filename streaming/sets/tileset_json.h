#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// The side table of a GeoPackage of ours, `terrella_tileset(key TEXT PRIMARY KEY, value TEXT)`: under `kTileSetKey`
/// stands the text that a directory keeps in `tileset.json`.
inline constexpr const char* kTileSetTable = "terrella_tileset";
inline constexpr const char* kTileSetKey = "tileset";
inline constexpr const char* kTileSetFile = "tileset.json";
/// Where squeezed tiles stand (TileGrid::reduced): a table beside `tiles`, a folder beside the levels'.
inline constexpr const char* kSqueezedTable = "terrella_squeezed_tiles";
inline constexpr const char* kSqueezedFolder = "squeezed";
/// A longer description is refused before it is parsed.
inline constexpr std::size_t kMaxTileSetJsonBytes = 1UL << 20;

/// Degrees without the rounding that the way through radians leaves: 45, not 45.000000000000007. 1e-11 degrees is a
/// micrometre on Earth. thread: any
[[nodiscard]] double tidy_degrees(Angle angle);

/// The description of a tile set as JSON text, fields as in streaming/README.md. Bytes that are not UTF-8 in a name are
/// replaced by U+FFFD. A `cut_key` that is not empty marks the set as written by `cut`. thread: any
[[nodiscard]] std::string to_tileset_json(const TileSetInfo& info, const std::string& cut_key = {});

/// The `cut_key` of a description; nothing if `cut` did not write it. thread: any
[[nodiscard]] std::optional<std::string> read_cut_key(std::string_view text);

/// Reads it back and checks every field. `where` (a path) begins the error, which names the field and what it may be.
/// Unknown fields are passed over. thread: any
[[nodiscard]] Result<TileSetInfo> parse_tileset_json(std::string_view text, const std::string& where);

}  // namespace terrella
