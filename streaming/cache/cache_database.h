#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "base/result.h"
#include "streaming/cache/sqlite_writer.h"
#include "streaming/cache/tile_cache.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Databases up to this size are checked completely on opening (about 0.1 s). In a larger database only the header and
/// the smallest table (`terrella_cache`) are checked. Damage in its tiles appears when they are read, or with `terrella
/// info --verify`.
inline constexpr std::uintmax_t kMaxQuickCheckBytes = 64UL << 20;

struct OpenedCache {
  SqliteWriter database;            ///< uses a write-ahead log
  std::filesystem::path set_aside;  ///< new name of the damaged file; empty: none
};

/// Opens or creates the cache file of a source.
/// - A cache with fewer levels than `info` is extended. A cache with more levels stays unchanged.
/// - A file found damaged by the check for its size is renamed NAME.damaged-N with its log, and a new file is created.
/// - Other files are refused by name and stay unchanged: a cache of another source or grid, a tile set that is no
///   cache, a database of another program, a cache of a later version.
[[nodiscard]] Result<OpenedCache, CacheOpenError> open_cache_database(const std::filesystem::path& path,
                                                                      const TileSetInfo& info,
                                                                      const std::string& source_key,
                                                                      const std::function<void()>& on_locked = {});

/// True if grid and format are equal, so that the same tiles lie in the same places. Names and levels may differ.
[[nodiscard]] bool same_tiles(const TileSetInfo& a, const TileSetInfo& b);

/// True if two keys (source_key()) belong to one source: they are equal, or one lists more levels than the other.
[[nodiscard]] bool same_source(const std::string& a, const std::string& b);

/// "PATH: the cache cannot be written: No space left on device; make space; …". Says if earlier tiles are safe.
[[nodiscard]] Error cache_error(const std::filesystem::path& path, const WriteError& error);

}  // namespace terrella
