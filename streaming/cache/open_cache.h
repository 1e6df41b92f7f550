#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "base/result.h"
#include "streaming/cache/sqlite_writer.h"
#include "streaming/cache/tile_cache.h"
#include "tiles/tile_source.h"

namespace terrella {

/// A whole database up to this size is checked on opening (about 0.1 s). Of a larger one only the head and the smallest
/// table (`terrella_cache`) are: damage in its tiles is met when they are read, and found by `terrella info --verify`.
inline constexpr std::uintmax_t kMaxQuickCheckBytes = 64UL << 20;

struct OpenedCache {
  SqliteWriter database;            ///< with a write-ahead log
  std::filesystem::path set_aside;  ///< what the damaged file was renamed to; empty: none
};

/// Opens the file as the cache of a source, or makes it. A file with fewer levels than `info` says is extended; one
/// with more stays as it is. Found to be damaged by the look that its size allows: renamed NAME.damaged-N with its log,
/// and made anew. Refused by name, and left as it is: another source's cache or grid, a tile set that is no cache,
/// another program's database, a later version's cache.
[[nodiscard]] Result<OpenedCache, CacheOpenError> open_cache_database(const std::filesystem::path& path,
                                                                      const TileSetInfo& info,
                                                                      const std::string& source_key,
                                                                      const std::function<void()>& on_locked = {});

/// True if both say that the same tiles lie in the same places: grid and format; names and levels may differ.
[[nodiscard]] bool same_tiles(const TileSetInfo& a, const TileSetInfo& b);

/// True if two keys (source_key()) are of one source: equal, or one names more levels than the other.
[[nodiscard]] bool same_source(const std::string& a, const std::string& b);

/// "PATH: the cache cannot be written: No space left on device; make space, …"
[[nodiscard]] Error cache_error(const std::filesystem::path& path, const WriteError& error);

}  // namespace terrella
