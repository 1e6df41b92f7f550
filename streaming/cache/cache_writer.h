#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>

#include "streaming/cache/cache_limit.h"
#include "streaming/cache/cache_place.h"
#include "streaming/cache/cache_rows.h"
#include "streaming/cache/sqlite_writer.h"
#include "streaming/cache/write_queue.h"

namespace terrella {

/// Writes batches into a cache and keeps the file and its log within their limits.
/// thread: one at a time; the counts any
class CacheWriter {
 public:
  [[nodiscard]] static WriteResult<std::unique_ptr<CacheWriter>> make(SqliteWriter database, std::filesystem::path path,
                                                                      int root_level, std::uint64_t max_bytes);

  /// Writes a batch in one transaction; after an error nothing of the batch is written. `no_room` has one entry for
  /// each change. An entry is set if its tile was not written because the limit is reached and nothing may be evicted.
  [[nodiscard]] Status write(const CacheBatch& batch, std::vector<bool>& no_room);
  /// Fails if the file is not under its name any more, or was damaged by another program.
  [[nodiscard]] Status check_place() { return place_.check(); }
  /// Gives free space back and empties the log. Called after some idle time.
  void tidy();
  /// Leaves one plain file without a log if no other connection has it open. The file can then be read from read-only
  /// media.
  void close();

  [[nodiscard]] const CacheBudget& budget() const { return budget_; }
  [[nodiscard]] std::uint64_t stored() const { return stored_; }
  [[nodiscard]] std::uint64_t evicted() const { return evicted_; }
  [[nodiscard]] std::uint64_t pins_changed() const { return pins_changed_; }
  [[nodiscard]] bool locked() const { return database_.waits_for_lock(); }

 private:
  CacheWriter(SqliteWriter database, std::filesystem::path path)
      : database_(std::move(database)), path_(std::move(path)), place_(path_) {}
  [[nodiscard]] WriteStatus write_rows(const CacheBatch& batch, std::int64_t now_unix_s, std::vector<bool>& no_room);
  [[nodiscard]] WriteStatus write_row(const CacheChange& change, std::int64_t now_unix_s);
  /// Evicts tiles until this many pages fit. Returns false if they do not fit and nothing more may be evicted.
  [[nodiscard]] WriteResult<bool> make_room(std::int64_t needed_pages);
  /// Number of pages over the limit after `needed_pages` more.
  [[nodiscard]] WriteResult<std::int64_t> pages_too_many(std::int64_t needed_pages);
  /// True if the tile of the change fits under the limit; the tile it replaces frees its space.
  [[nodiscard]] WriteResult<bool> fits(const CacheChange& change);
  [[nodiscard]] WriteStatus give_back_pages();
  void keep_log_short();
  /// Returns false if the checkpoint did not complete.
  bool checkpoint(const char* mode, std::chrono::milliseconds patience);

  SqliteWriter database_;
  const std::filesystem::path path_;
  CachePlace place_;
  CacheBudget budget_;
  std::int64_t page_bytes_ = 0;
  std::optional<CacheRows> rows_;
  std::optional<SqliteStatement> begin_, commit_, rollback_, page_count_, free_count_;
  std::atomic<std::uint64_t> stored_ = 0;
  std::atomic<std::uint64_t> evicted_ = 0;
  std::atomic<std::uint64_t> pins_changed_ = 0;
  std::uint64_t evicted_now_ = 0;  ///< count of the open transaction
  std::uint64_t pins_now_ = 0;     ///< count of the open transaction
};

}  // namespace terrella
