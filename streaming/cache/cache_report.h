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

/// What a cache holds. thread: any
struct CacheReport {
  TileSetInfo info;
  std::string source_key;
  std::int64_t tiles = 0;
  std::int64_t expired_tiles = 0;
  std::int64_t pinned_tiles = 0;                   ///< of the coarsest level, or preloaded: never evicted
  std::uint64_t used_bytes = 0;                    ///< of the file, without pages that are free
  std::array<std::int64_t, 4> absences{};          ///< by Absence
  std::array<std::int64_t, 4> expired_absences{};  ///< of them
  /// Of verify_cache(): what is wrong with the database, in SQLite's words; empty: it is sound.
  std::optional<std::vector<std::string>> problems;
};

/// True if the file says that it is a cache.
[[nodiscard]] bool is_cache(const std::filesystem::path& path);

/// Counts what is in a cache, which may be in use. Nothing is written. The error names the path.
[[nodiscard]] Result<CacheReport> read_cache_report(const std::filesystem::path& path, std::int64_t now_unix_s);

/// The same, and reads every page of the database (PRAGMA integrity_check): seconds for each gigabyte.
[[nodiscard]] Result<CacheReport> verify_cache(const std::filesystem::path& path, std::int64_t now_unix_s);

}  // namespace terrella
