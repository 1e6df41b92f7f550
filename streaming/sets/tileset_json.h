#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Side table of Terrella's GeoPackages, `terrella_tileset(key TEXT PRIMARY KEY, value TEXT)`. The key `kTileSetKey`
/// has the text that a directory keeps in `tileset.json`.
inline constexpr const char* kTileSetTable = "terrella_tileset";
inline constexpr const char* kTileSetKey = "tileset";
inline constexpr const char* kTileSetFile = "tileset.json";
/// Field of a description that marks a set as written by `cut` or `convert`; also in the metadata of MBTiles and
/// PMTiles.
inline constexpr const char* kCutKeyField = "cut_key";
/// Location of squeezed tiles (TileGrid::reduced): a table beside `tiles`, a folder beside the level folders.
inline constexpr const char* kSqueezedTable = "terrella_squeezed_tiles";
inline constexpr const char* kSqueezedFolder = "squeezed";
/// A longer description is refused before it is parsed.
inline constexpr std::size_t kMaxTileSetJsonBytes = 1UL << 20;

/// Angle in degrees without the rounding error of radians: 45, not 45.000000000000007. Rounds to 1e-11 degrees, a
/// micrometre on Earth. thread: any
[[nodiscard]] double tidy_degrees(Angle angle);

/// Describes a tile set as JSON text, with fields as in streaming/README.md. Replaces bytes in names that are not UTF-8
/// by U+FFFD. A non-empty `cut_key` marks the set as written by `cut`. thread: any
[[nodiscard]] std::string to_tileset_json(const TileSetInfo& info, const std::string& cut_key = {});

/// The `cut_key` of a description; nothing if neither `cut` nor `convert` wrote it. thread: any
[[nodiscard]] std::optional<std::string> read_cut_key(std::string_view text);

/// Parses a description and checks every field. The error begins with `where` (a path) and names the field and its
/// allowed values. Unknown fields are ignored. thread: any
[[nodiscard]] Result<TileSetInfo> parse_tileset_json(std::string_view text, const std::string& where);

/// A body that the metadata of MBTiles or PMTiles state; empty if it is none that is known. thread: any
[[nodiscard]] std::string stated_body(std::string text);

/// Ending of the files of tiles in a folder: "jpg", "png", "webp", or "tif" for floats. thread: any
[[nodiscard]] const char* tile_ending(const TileSetInfo& info);

}  // namespace terrella
