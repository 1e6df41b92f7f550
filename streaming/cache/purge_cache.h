#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "base/result.h"

namespace terrella {

/// Places of one column: the rows [first_y, last_y].
struct PurgeRun {
  int level = 0;
  std::int64_t x = 0;
  std::int64_t first_y = 0;
  std::int64_t last_y = -1;
};

/// The records that a purge removes: those that fit all that is set.
struct PurgeWish {
  std::function<std::optional<PurgeRun>()> next_places{};  ///< gives runs until nothing; none: all places
  std::optional<std::int64_t> stored_before_unix_s{};
  /// Pinned tiles have no last use and stay. Records of missing tiles count as used when they were stored.
  std::optional<std::int64_t> used_before_unix_s{};
  bool dry_run = false;                ///< counts, and changes nothing
  std::function<bool()> goes_on = {};  ///< asked now and then; false stops the purge
};

struct PurgeSummary {
  std::int64_t tiles = 0;
  std::int64_t missing = 0;              ///< records of missing tiles
  std::int64_t tile_bytes = 0;           ///< bytes of the tiles
  std::uintmax_t file_bytes_before = 0;  ///< size of the file
  std::uintmax_t file_bytes = 0;         ///< size afterwards; the same for a dry run
  bool stopped = false;                  ///< the rest is still there
  std::optional<Error> fault{};          ///< ended the purge; the rest is still there
};

/// Removes records from a cache, pinned tiles too, and gives the file's space back (incremental_vacuum). Other programs
/// may use the cache meanwhile: a step takes the file only if it has something to remove. After a fault or a stop the
/// cache is sound, and the same purge goes on. A file that is no cache is refused and stays unchanged; the error
/// contains the path. thread: any
[[nodiscard]] Result<PurgeSummary> purge_cache(const std::filesystem::path& path, const PurgeWish& wish);

}  // namespace terrella
