#pragma once

#include <filesystem>
#include <string>

#include "geo/result.h"
#include "streaming/cache/sqlite_writer.h"
#include "streaming/tile_source.h"

namespace terrella {

/// A whole database up to this size is checked on opening (about 0.1 s); of a larger one the side tables are.
inline constexpr std::uintmax_t kMaxQuickCheckBytes = 64UL << 20;

struct OpenedCache {
  SqliteWriter database;            ///< with a write-ahead log
  std::filesystem::path set_aside;  ///< what the damaged file was renamed to; empty: none
};

/// Opens the file as the cache of a source, or makes it. Damaged: renamed NAME.damaged-N with its log, and made anew.
/// Refused by name, and left as it is: another source's cache, a tile set that is no cache, a later version's cache.
[[nodiscard]] Result<OpenedCache> open_cache_database(const std::filesystem::path& path, const TileSetInfo& info,
                                                      const std::string& source_key);

/// True if both say that the same tiles lie in the same places: grid and format; names may differ.
[[nodiscard]] bool same_tiles(const TileSetInfo& a, const TileSetInfo& b);

/// "PATH: the cache cannot be written: No space left on device; make space, …"
[[nodiscard]] Error cache_error(const std::filesystem::path& path, const WriteError& error);

}  // namespace terrella
