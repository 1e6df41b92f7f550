#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "tiles/tile_source.h"

namespace terrella {

/// Summary of a cache's content. thread: any
struct CacheReport {
  TileSetInfo info;
  std::string source_key;
  std::int64_t tiles = 0;
  std::int64_t expired_tiles = 0;
  std::int64_t pinned_tiles = 0;                  ///< tiles of the coarsest level and preloaded tiles; never evicted
  std::uint64_t used_bytes = 0;                   ///< size of the file without free pages
  std::array<std::int64_t, 4> missing{};          ///< number of each kind of MissingKind
  std::array<std::int64_t, 4> expired_missing{};  ///< the expired part of `missing`
  /// Set by verify_cache(): faults of the database, in SQLite's words. An empty list means a sound database.
  std::optional<std::vector<std::string>> problems;
};

/// True if the file declares itself a cache.
[[nodiscard]] bool is_cache(const std::filesystem::path& path);

/// The source key of a cache; empty if the file is none or cannot be read. thread: any
[[nodiscard]] std::string read_cache_source(const std::filesystem::path& path);

/// Counts the content of a cache, which may be in use. Writes nothing. The error contains the path.
[[nodiscard]] Result<CacheReport> read_cache_report(const std::filesystem::path& path, std::int64_t now_unix_s);

/// Like read_cache_report(), but also reads every page of the database (PRAGMA integrity_check). Takes seconds per
/// gigabyte.
[[nodiscard]] Result<CacheReport> verify_cache(const std::filesystem::path& path, std::int64_t now_unix_s);

}  // namespace terrella
