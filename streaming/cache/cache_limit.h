#pragma once

#include <cstdint>

namespace terrella {

/// How a limit on a cache's size is kept: pure arithmetic, in pages of the file.
/// The file and its write-ahead log together stay within the limit ± 5 %, so the log gets its share of the limit, and
/// what is written at a time is small against it.
struct CacheBudget {
  std::uint64_t max_bytes = 0;    ///< 0: no limit
  std::uint64_t log_bytes = 0;    ///< the log is written back into the file when it is this long
  std::uint64_t batch_bytes = 0;  ///< of tiles in one transaction
  std::int64_t file_pages = 0;    ///< 0: no limit
};
[[nodiscard]] CacheBudget cache_budget(std::uint64_t max_bytes, std::int64_t page_bytes);

/// Pages that `tiles` tiles of `bytes` bytes in all need at most, with their rows and indexes.
[[nodiscard]] std::int64_t pages_for(std::uint64_t bytes, std::size_t tiles, std::int64_t page_bytes);

/// About what `tiles` tiles of `bytes_a_tile` bytes in the mean take of a file, with rows, indexes and pages that are
/// not quite full.
[[nodiscard]] double file_bytes(std::int64_t tiles, double bytes_a_tile);

/// The pages that must be freed before `needed` more are written.
[[nodiscard]] std::int64_t pages_over(const CacheBudget& budget, std::int64_t pages, std::int64_t free_pages,
                                      std::int64_t needed);

}  // namespace terrella
