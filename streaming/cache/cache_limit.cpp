#include "streaming/cache/cache_limit.h"

#include <algorithm>

namespace terrella {
namespace {

constexpr std::uint64_t kLogBytes = 32UL << 20;
constexpr std::uint64_t kBatchBytes = 8UL << 20;
/// Before it is written back, the log may exceed its share by one batch and some pages of indexes.
constexpr std::uint64_t kLogShare = 64;
constexpr std::uint64_t kBatchShare = 128;
constexpr std::uint64_t kLeastLogBytes = 128UL << 10;
constexpr std::uint64_t kLeastBatchBytes = 64UL << 10;
/// Pages of indexes and of the page map that a transaction may add to its tiles.
constexpr std::int64_t kSpare = 8;
/// Bytes in side tables and indexes for each tile.
constexpr std::uint64_t kRowBytes = 100;
/// Pages hold a few tiles each, so the ends of pages stay empty (streaming/cache/README.md, "Figures").
constexpr double kPagesFilled = 1.08;

}  // namespace

CacheBudget cache_budget(std::uint64_t max_bytes, std::int64_t page_bytes) {
  if (max_bytes == 0) return {.max_bytes = 0, .log_bytes = kLogBytes, .batch_bytes = kBatchBytes, .file_pages = 0};
  CacheBudget budget{.max_bytes = max_bytes};
  budget.log_bytes = std::clamp(max_bytes / kLogShare, kLeastLogBytes, kLogBytes);
  budget.batch_bytes = std::clamp(max_bytes / kBatchShare, kLeastBatchBytes, kBatchBytes);
  const std::uint64_t log = std::min(max_bytes / 2, 2 * budget.log_bytes);
  budget.file_pages = std::max<std::int64_t>(1, static_cast<std::int64_t>(max_bytes - log) / page_bytes);
  return budget;
}

std::int64_t pages_for(std::uint64_t bytes, std::size_t tiles, std::int64_t page_bytes) {
  const std::uint64_t all = bytes + kRowBytes * static_cast<std::uint64_t>(tiles);
  return static_cast<std::int64_t>(all) / page_bytes + kSpare;
}

double file_bytes(std::int64_t tiles, double bytes_a_tile) {
  return kPagesFilled * static_cast<double>(tiles) * (bytes_a_tile + static_cast<double>(kRowBytes));
}

std::int64_t pages_over(const CacheBudget& budget, std::int64_t pages, std::int64_t free_pages, std::int64_t needed) {
  if (budget.file_pages == 0) return 0;
  return std::max<std::int64_t>(0, pages - free_pages + needed - budget.file_pages);
}

}  // namespace terrella
