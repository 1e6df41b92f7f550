#pragma once

#include <cstdint>

namespace terrella {

/// Arithmetic of the size limit of a cache, in pages of the file.
/// The file and its write-ahead log together stay within the limit ± 5 %. The log therefore gets a share of the limit,
/// and one batch is small compared with the limit.
struct CacheBudget {
  std::uint64_t max_bytes = 0;    ///< 0: no limit
  std::uint64_t log_bytes = 0;    ///< length at which the log is written back into the file
  std::uint64_t batch_bytes = 0;  ///< tile bytes in one transaction
  std::int64_t file_pages = 0;    ///< 0: no limit
};
[[nodiscard]] CacheBudget cache_budget(std::uint64_t max_bytes, std::int64_t page_bytes);

/// Upper bound of the pages for `tiles` tiles of `bytes` bytes in total, with their rows and indexes.
[[nodiscard]] std::int64_t pages_for(std::uint64_t bytes, std::size_t tiles, std::int64_t page_bytes);

/// Approximate file space of `tiles` tiles of `bytes_a_tile` bytes on average, with rows, indexes and partly filled
/// pages.
[[nodiscard]] double file_bytes(std::int64_t tiles, double bytes_a_tile);

/// Number of pages to free before `needed` more pages are written.
[[nodiscard]] std::int64_t pages_over(const CacheBudget& budget, std::int64_t pages, std::int64_t free_pages,
                                      std::int64_t needed);

}  // namespace terrella
