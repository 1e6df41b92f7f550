#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/result.h"
#include "streaming/cache/sqlite_writer.h"
#include "tiles/tile_source.h"

namespace terrella {

/// The side tables of a cache; columns in README.md.
inline constexpr const char* kCacheTable = "terrella_cache";                   ///< key, value: 'version', 'source'
inline constexpr const char* kCacheTilesTable = "terrella_cache_tiles";        ///< one row for each tile, by its id
inline constexpr const char* kCacheAbsencesTable = "terrella_cache_absences";  ///< places without a tile, and why
inline constexpr int kCacheVersion = 1;
inline constexpr std::int64_t kCachePageBytes = 4096;

/// How an absence is named in the file; never change one.
[[nodiscard]] const char* absence_name(Absence kind);
/// An unknown name is `failed`: it is asked for again.
[[nodiscard]] Absence absence_named(const std::string& name);

/// Fills an empty database: a GeoPackage and the side tables.
[[nodiscard]] WriteStatus write_cache_schema(SqliteWriter& database, const TileSetInfo& info,
                                             const std::string& source_key);

/// Makes the file, whole from the first moment that it has its name: no other process sees half of it. A file that has
/// the name by then is left alone.
[[nodiscard]] Status create_cache_file(const std::filesystem::path& path, const TileSetInfo& info,
                                       const std::string& source_key);

/// True if the grid has every level that `wanted` has.
[[nodiscard]] bool has_levels_of(const TileGrid& grid, const TileGrid& wanted);

/// Adds to a cache the levels of `grid` that it does not have: the rows of its tile matrices, and its own description.
[[nodiscard]] WriteStatus extend_levels(SqliteWriter& database, const TileGrid& grid);

/// What a database is to us.
enum class FileKind {
  cache,
  tile_set,  ///< a GeoPackage of somebody's
  other,     ///< another SQLite database
  newer,     ///< a cache of a later version
  tampered,  ///< says that it is a cache, and its tables are not those of one
};
[[nodiscard]] WriteResult<FileKind> kind_of(SqliteWriter& database);

}  // namespace terrella
