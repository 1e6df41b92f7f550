#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/result.h"
#include "streaming/cache/sqlite_writer.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Names of the side tables of a cache; README.md describes the columns.
inline constexpr const char* kCacheTable = "terrella_cache";  ///< key, value: 'version', 'source'
/// One row for each tile, keyed by the tile's id.
inline constexpr const char* kCacheTilesTable = "terrella_cache_tiles";
/// Places without a tile, and the reason.
inline constexpr const char* kCacheMissingTable = "terrella_cache_absences";
/// Beginning of the source key of a cache of byte ranges (streaming/remote_tiff/range_cache.h).
inline constexpr const char* kRangesKey = "{\"ranges\":";
inline constexpr int kCacheVersion = 1;
inline constexpr std::int64_t kCachePageBytes = 4096;

/// Name of a missing-tile record in the file. Never change a name.
[[nodiscard]] const char* missing_name(MissingKind kind);
/// Returns `failed` for an unknown name; the tile is then requested again.
[[nodiscard]] MissingKind missing_named(const std::string& name);

/// Makes an empty database a GeoPackage with the side tables.
[[nodiscard]] WriteStatus write_cache_schema(SqliteWriter& database, const TileSetInfo& info,
                                             const std::string& source_key);

/// Creates the file. The file is complete when it gets its name, so no other process sees half of it. A file that has
/// the name by then is left alone.
[[nodiscard]] Status create_cache_file(const std::filesystem::path& path, const TileSetInfo& info,
                                       const std::string& source_key);

/// True if the grid has every level of `wanted`.
[[nodiscard]] bool has_levels_of(const TileGrid& grid, const TileGrid& wanted);

/// Adds the missing levels of `grid` to a cache: rows of tile matrices, and the cache's own description.
[[nodiscard]] WriteStatus extend_levels(SqliteWriter& database, const TileGrid& grid);

/// Kind of an existing database file.
enum class FileKind {
  cache,
  tile_set,  ///< a GeoPackage of another program
  other,     ///< another SQLite database
  newer,     ///< a cache of a later version
  tampered,  ///< declares itself a cache, but has other tables
};
[[nodiscard]] WriteResult<FileKind> kind_of(SqliteWriter& database);

}  // namespace terrella
